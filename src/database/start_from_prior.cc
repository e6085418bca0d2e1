#include "pbnbrdf/database/start_from_prior.h"

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/database/code_fit.h"
#include "pbnbrdf/problem/sampling.h"
#include "problem/fit_target.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kSamples = 2000;  // at most, for a code of a few dozen numbers

// What a code is found from.
std::vector<BrdfSample> SamplesOf(const Brdf& material, Encoding encoding) {
  if (!material.IsIsotropic() && IsIsotropic(encoding)) {
    Fail("the material is anisotropic, the database's are isotropic");
  }
  std::vector<BrdfSample> measured = TrainingMeasurements(material);
  if (measured.empty()) {
    const auto target = FitTarget(material, encoding);
    return DrawSamples(*target, SampleSet::kTraining, Sampling::kHighlight, kSamples, /*seed=*/1);
  }
  if (measured.size() > kSamples) measured.resize(kSamples);
  return measured;
}

bool IsSame(const NetworkShape& a, const NetworkShape& b) {
  return a.encoding() == b.encoding() && a.Description() == b.Description();
}

}  // namespace

NeuralBrdf Expected(const WeightFamily& family, const Brdf& material) {
  const NetworkShape& shape = family.shape();
  const std::vector<double> code = FitCode(family, SamplesOf(material, shape.encoding()));
  return NeuralBrdf(shape, family.WeightsAt(code));
}

MerlBrdf Expected(const TablePca& pca, const Brdf& material) {
  return pca.At(FitCode(pca, SamplesOf(material, Encoding::kMerl)));
}

void StartFromPrior(const WeightFamily& family, const Brdf& material, FitProblem* problem,
                    FitOptions* options) {
  NeuralBrdf network = Expected(family, material);
  if (!problem->network.encoding) problem->network.encoding = family.shape().encoding();
  if (IsSame(problem->For(material).Shape(), family.shape())) {
    options->initial_weights = network.weights();
  }
  options->expected = std::make_shared<NeuralBrdf>(std::move(network));
}

void StartFromPrior(const TablePca& pca, const Brdf& material, FitProblem*, FitOptions* options) {
  options->expected = std::make_shared<MerlBrdf>(Expected(pca, material));
}

}  // namespace pbnbrdf
