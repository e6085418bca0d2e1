#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {

Inputs<double> Encode(Encoding encoding, const DirectionPair& pair) {
  const auto& [wi, wo] = pair;
  return Encode(encoding, HalfDiffFromPair<double>({wi.x, wi.y, wi.z}, {wo.x, wo.y, wo.z}));
}

}  // namespace pbnbrdf
