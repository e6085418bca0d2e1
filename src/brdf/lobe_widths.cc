#include "pbnbrdf/brdf/lobe_widths.h"

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

std::string LobeWidths::Description() const {
  return AreEqual() ? StrCat("alpha ", x) : StrCat("alpha_x ", x, ", alpha_y ", y);
}

}  // namespace pbnbrdf
