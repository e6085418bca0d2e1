// one_channel.h: measurements of a single channel.
#pragma once

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// A grey material, measured at random directions in one channel.
inline ScatteredBrdf MeasuredInOneChannel(const Brdf& material, std::size_t count) {
  ScatteredData data;
  data.channels = 1;
  for (const DirectionPair& pair : RandomPairs(count, /*seed=*/8)) {
    Rgb value;
    material.Evaluate({&pair, 1}, {&value, 1});
    data.samples.push_back({pair, {value[0], value[0], value[0]}});
  }
  return ScatteredBrdf(std::move(data));
}

}  // namespace pbnbrdf
