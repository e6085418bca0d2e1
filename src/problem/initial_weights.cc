#include "problem/initial_weights.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace pbnbrdf {

constexpr double kNbrdfBound = 0.05;  // of the published scripts

std::vector<double> InitialWeights(const NetworkShape& shape, std::span<const BrdfSample> samples,
                                   std::uint64_t seed, Initialization initialization) {
  const bool glorot = initialization == Initialization::kGlorot;
  std::mt19937_64 random(seed);
  std::vector<double> weights(shape.num_weights(), 0.0);
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    const int in = shape.in(layer), out = shape.out(layer);
    const double bound = glorot ? std::sqrt(6.0 / (in + out)) : kNbrdfBound;
    double* row = weights.data() + shape.offset(layer);
    for (int o = 0; o < out; ++o, row += in + 1) {
      for (int i = 0; i < in; ++i) {
        const double u = static_cast<double>(random() >> 11) * 0x1p-53;
        row[i] = bound * (2.0 * u - 1.0);
      }
      if (!glorot || layer + 1 < shape.num_layers()) continue;
      for (const BrdfSample& sample : samples) {
        row[in] += std::log1p(std::max(sample.value[o], 0.0)) / static_cast<double>(samples.size());
      }
    }
  }
  return weights;
}

}  // namespace pbnbrdf
