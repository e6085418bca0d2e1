#include "jacobian_methods.h"

#include "pbnbrdf/models/builtin.h"
#include "problem/initial_weights.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

// The largest difference of the lower triangles, relative to the diagonal; infinite if one isn't
// finite.
double HessianDifference(const Linearization& exact, const Linearization& at) {
  const std::size_t p = exact.gradient.size();
  double largest = 0.0;
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double scale = std::sqrt(exact.hessian[i * p + i] * exact.hessian[j * p + j]);
      const double difference = (at.hessian[i * p + j] - exact.hessian[i * p + j]) / scale;
      if (!std::isfinite(difference)) return INFINITY;
      largest = std::max(largest, std::abs(difference));
    }
  }
  return largest;
}

// More samples than the dense Jacobian holds at once, and a last batch that isn't full.
TEST(MakeEvaluation, AllMethodsGiveTheSameNormalEquations) {
  FitProblem problem;
  problem.network.hidden = {5, 4};
  problem.terms.SetWeight("energy", 0.0);
  const std::vector<BrdfSample> samples =
      DrawSamples(*MakeBuiltin("satin-gold"), SampleSet::kTraining, problem.sampling.Angles(), 1200,
                  /*seed=*/1);
  const std::vector<double> weights = InitialWeights(problem.Shape(), samples, /*seed=*/1);
  Linearization exact;
  MakeEvaluation(DerivativeMethod::kAutodiff, problem, samples)(weights.data(), &exact);
  ASSERT_EQ(exact.hessian.size(), weights.size() * weights.size());
  for (const auto& [name, method] : kDerivativeMethods) {
    Linearization at;
    MakeEvaluation(method, problem, samples)(weights.data(), &at);
    // Passes in single precision: about 1e-7 for each of a few operations.
    EXPECT_NEAR(at.cost, exact.cost, 1e-5 * exact.cost) << name;
    EXPECT_LT(HessianDifference(exact, at), 1e-4) << name;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_NEAR(at.gradient[i], exact.gradient[i],
                  1e-4 * std::sqrt(exact.cost * exact.hessian[i * weights.size() + i]) + 1e-12)
          << name << " " << i;
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
