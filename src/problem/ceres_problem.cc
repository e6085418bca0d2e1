#include "pbnbrdf/problem/ceres_problem.h"

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/loss_function.h>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"
#include "pbnbrdf/residuals/energy_residual.h"
#include "pbnbrdf/residuals/log_residual.h"
#include "pbnbrdf/residuals/network_residual.h"
#include "problem/condensed_cost_function.h"

namespace pbnbrdf {
namespace {

constexpr int kJetSize = 16;  // derivatives carried by a pass through the network

template <typename Term>
ceres::CostFunction* MakeAutodiff(const NetworkShape& shape,
                                  std::vector<typename NetworkResidual<Term>::Input> inputs,
                                  Term term) {
  auto* cost = new ceres::DynamicAutoDiffCostFunction<NetworkResidual<Term>, kJetSize>(
      new NetworkResidual<Term>(shape, std::move(inputs), std::move(term)));
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    cost->AddParameterBlock(shape.block_size(layer));
  }
  cost->SetNumResiduals(Term::kNumResiduals);
  return cost;
}

ceres::LossFunction* Weighted(std::unique_ptr<ceres::LossFunction> loss, double weight) {
  return new ceres::ScaledLoss(loss.release(), weight, ceres::TAKE_OWNERSHIP);
}

template <typename Term>
void AddPointTerm(const FitProblem& problem, std::span<const BrdfSample> samples, double weight,
                  const std::vector<double*>& blocks, ceres::Problem* ceres_problem) {
  if (weight == 0.0) return;
  const NetworkShape shape = problem.Shape();
  for (const BrdfSample& s : samples) {
    ceres_problem->AddResidualBlock(
        MakeAutodiff(shape, {Encode(shape.encoding(), s.pair)}, Term(s.value, CosI(s.pair))),
        Weighted(MakeLoss(problem.loss, problem.loss_scale),
                 weight / static_cast<double>(samples.size())),
        blocks);
  }
}

void AddEnergyTerm(const FitProblem& problem, std::span<const EnergyStratum> strata,
                   const std::vector<double*>& blocks, ceres::Problem* ceres_problem) {
  if (problem.energy_weight == 0.0) return;
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
    ceres_problem->AddResidualBlock(MakeAutodiff(shape, std::move(inputs), std::move(residual)),
                                    Weighted(nullptr, problem.energy_weight), blocks);
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
  AddPointTerm<LogResidual>(problem, samples, problem.log_weight, blocks, ceres_problem);
  AddPointTerm<ChromaticityResidual>(problem, samples, problem.chromaticity_weight, blocks,
                                     ceres_problem);
  AddEnergyTerm(problem, strata, blocks, ceres_problem);
}

}  // namespace pbnbrdf
