#include "pbnbrdf/problem/fit_problem.h"

#include <ceres/loss_function.h>

#include <cmath>
#include <random>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kMostSamples = 100'000'000;
constexpr double kNbrdfBound = 0.05;

void CheckWeight(const char* field, double weight) {
  if (!(weight >= 0.0) || !std::isfinite(weight)) {
    Fail(field, " = ", weight, "; must be finite and >= 0");
  }
}

template <typename Integer>
void CheckCount(const char* field, Integer value, Integer least, Integer most) {
  if (value < least || value > most) {
    Fail(field, " = ", value, "; must be ", least, " to ", most);
  }
}

}  // namespace

SampleAngles FitProblem::Angles() const {
  SampleAngles angles = sampling;
  if (!asked) return angles;
  angles.asked = asked;
  angles.floor = asked_floor;
  return angles;
}

void FitProblem::Validate() const {
  Shape();
  CheckWeight("log_weight", log_weight);
  CheckWeight("chromaticity_weight", chromaticity_weight);
  CheckWeight("energy_weight", energy_weight);
  if (log_weight + chromaticity_weight == 0.0) {
    Fail("terms: log or chromaticity must be among them, with a weight > 0");
  }
  if (channels == 1 && chromaticity_weight > 0.0) {
    Fail("terms: chromaticity is of no use to a single channel");
  }
  if (!(loss_scale > 0.0) || !std::isfinite(loss_scale)) {
    Fail("loss_scale = ", loss_scale, "; must be finite and > 0");
  }
  CheckCount("samples", samples, std::size_t{1}, kMostSamples);
  CheckCount("first_samples", first_samples, std::size_t{1}, kMostSamples);
  if (!(growth > 1.0) || !std::isfinite(growth))
    Fail("growth = ", growth, "; must be finite and > 1");
  if (!(asked_floor >= 0.0 && asked_floor <= 1.0)) {
    Fail("asked_floor = ", asked_floor, "; must be 0 to 1");
  }
  CheckCount("energy_strata", energy_strata, 1, 1024);
  CheckCount("energy_azimuths", energy_azimuths, 1, 1024);
  CheckCount("energy_theta", energy_theta, 2, 1024);
  CheckCount("energy_phi", energy_phi, 2, 1024);
}

std::unique_ptr<ceres::LossFunction> MakeLoss(Loss loss, double scale) {
  switch (loss) {
    case Loss::kL2:
    case Loss::kAbsolute:
      return nullptr;
    case Loss::kSoftL1:
      return std::make_unique<ceres::SoftLOneLoss>(scale);
    case Loss::kHuber:
      return std::make_unique<ceres::HuberLoss>(scale);
    case Loss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(scale);
  }
  return nullptr;
}

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
        row[in] += std::log1p(sample.value[o]) / static_cast<double>(samples.size());
      }
    }
  }
  return weights;
}

}  // namespace pbnbrdf
