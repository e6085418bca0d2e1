#include "pbnbrdf/problem/ceres_problem.h"

#include "pbnbrdf/residuals/energy_residual.h"
#include "problem/condensed_cost_function.h"
#include "problem/jet_term.h"
#include "problem/robust_loss.h"
#include "problem/terms.h"

namespace pbnbrdf {
namespace {

ceres::LossFunction* Weighted(std::unique_ptr<ceres::LossFunction> loss, double weight) {
  return new ceres::ScaledLoss(loss.release(), weight, ceres::TAKE_OWNERSHIP);
}

void AddSampleTerm(const FitProblem& problem, const WeightedSampleTerm& term,
                   std::span<const BrdfSample> samples, const std::vector<double*>& blocks,
                   ceres::Problem* ceres_problem) {
  const NetworkShape shape = problem.Shape();
  double total_weight = 0.0;
  for (const BrdfSample& sample : samples) total_weight += sample.weight;
  for (const BrdfSample& sample : samples) {
    ceres_problem->AddResidualBlock(
        term.term->NewCostFunction(shape, sample),
        Weighted(MakeLoss(problem.terms), term.weight * sample.weight / total_weight), blocks);
  }
}

void AddEnergyTerm(const FitProblem& problem, std::span<const EnergyStratum> strata,
                   const std::vector<double*>& blocks, ceres::Problem* ceres_problem) {
  const NetworkShape shape = problem.Shape();
  for (std::size_t k = 0; k < strata.size(); ++k) {
    const EnergyStratum& stratum = strata[k];
    std::vector<NetworkResidual<EnergyResidual>::Input> inputs;
    std::vector<double> node_weights;
    for (const AlbedoNode& node : QuadratureOfStratum(problem, k).Nodes(stratum.wi)) {
      inputs.push_back(Encode(shape.encoding(), node.pair));
      node_weights.push_back(node.weight);
    }
    EnergyResidual residual(stratum.solid_angle, std::move(node_weights), stratum.limit);
    ceres_problem->AddResidualBlock(
        NewAutodiffCostFunction(shape, std::move(inputs), std::move(residual)),
        Weighted(nullptr, problem.terms.EnergyWeight()), blocks);
  }
}

}  // namespace

void AddCondensed(Objective* objective, double* weights, ceres::Problem* ceres_problem) {
  ceres_problem->AddResidualBlock(new CondensedCostFunction(objective), nullptr,
                                  objective->shape().Blocks(weights));
}

void AddAutodiff(const FitProblem& problem, std::span<const BrdfSample> samples,
                 std::span<const EnergyStratum> strata, double* weights,
                 ceres::Problem* ceres_problem) {
  const std::vector<double*> blocks = problem.Shape().Blocks(weights);
  for (const WeightedSampleTerm& term : MakeSampleTerms(problem.terms)) {
    AddSampleTerm(problem, term, samples, blocks, ceres_problem);
  }
  if (problem.terms.EnergyWeight() > 0.0) AddEnergyTerm(problem, strata, blocks, ceres_problem);
}

}  // namespace pbnbrdf
