// The formulas of the analytic models, differentiated by Ceres' jets.
#include <ceres/jet.h>

#include "brdf/direction_pairs.h"
#include "models/analytic_formulas.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

constexpr int kMostScalars = 24;
using Jet = ceres::Jet<double, kMostScalars>;

// A place within each parameter's bounds, none at its initial value.
std::vector<double> SomeParameters(const AnalyticModel& model, int lobes, unsigned seed) {
  std::vector<double> scalars;
  const std::vector<double> random = RandomNumbers(kMostScalars, 0.2, 0.8, seed);
  for (const PlacedParameter& placed : PlacedParameters(model, lobes)) {
    const ModelParameter& parameter = *placed.parameter;
    for (int c = 0; c < parameter.size; ++c) {
      const double r = random[scalars.size()];
      if (parameter.role == FitRole::kWidth) {
        scalars.push_back(0.3 * parameter.narrow + r * parameter.wide);
      } else {
        scalars.push_back(parameter.lower + r * (std::min(parameter.upper, 2.0) - parameter.lower));
      }
    }
  }
  return scalars;
}

// The largest difference of the jets' derivatives from central differences, relative to the largest
// derivative at the pair, over pairs and parameters.
template <typename Formula>
double WorstDerivative(double flaw) {
  const AnalyticModel& model = FindAnalyticModel(Formula::kName);
  const int lobes = model.lobe.empty() ? 0 : kMaxLobes;
  std::vector<double> scalars = SomeParameters(model, lobes, /*seed=*/31);
  std::array<Jet, kMostScalars> jets;
  for (std::size_t i = 0; i < scalars.size(); ++i) jets[i] = Jet(scalars[i], static_cast<int>(i));
  double worst = 0.0;
  for (const DirectionPair& pair : RandomPairs(100, /*seed=*/32)) {
    const ReflectionGeometry g(pair);
    const auto f = EvaluateFormula<Formula>(g, jets.data(), lobes);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(f[c].a, model.evaluate(g, scalars.data(), lobes)[c], 1e-13 * f[c].a);
      const double scale = f[c].v.cwiseAbs().maxCoeff();
      for (std::size_t i = 0; i < scalars.size(); ++i) {
        const double at = scalars[i], step = 1e-5 * at;
        scalars[i] = at + step;
        const double above = model.evaluate(g, scalars.data(), lobes)[c];
        scalars[i] = at - step;
        const double below = model.evaluate(g, scalars.data(), lobes)[c];
        scalars[i] = at;
        const double difference = (above - below) / (2 * step) * (1.0 + flaw);
        worst = std::max(worst, std::abs(f[c].v[static_cast<int>(i)] - difference) / scale);
      }
    }
  }
  return worst;
}

template <typename Formula>
class Derivatives : public testing::Test {};

template <typename Tuple>
struct TestTypes;
template <typename... Formulas>
struct TestTypes<std::tuple<Formulas...>> {
  using Type = testing::Types<Formulas...>;
};

TYPED_TEST_SUITE(Derivatives, TestTypes<AnalyticFormulas>::Type);

TYPED_TEST(Derivatives, AreThoseOfTheValues) { EXPECT_LT(WorstDerivative<TypeParam>(0.0), 1e-6); }

TYPED_TEST(Derivatives, AFlawOfAHundredthIsSeen) {
  EXPECT_GT(WorstDerivative<TypeParam>(0.01), 1e-3);
}

}  // namespace
}  // namespace pbnbrdf
