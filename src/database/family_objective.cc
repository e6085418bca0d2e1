#include "database/family_objective.h"

#include <algorithm>
#include <numeric>

#include "base/about.h"
#include "base/parallel.h"
#include "pbnbrdf/problem/sampling.h"
#include "problem/fit_target.h"

namespace pbnbrdf {

FamilyObjective::FamilyObjective(std::span<const DatabaseMaterial> materials,
                                 const FitProblem& problem)
    : samples_(materials.size(), EncodedSamples(*problem.network.encoding)) {
  const SamplingOptions& sampling = problem.sampling;
  ParallelFor(materials.size(), [&](std::size_t m) {
    About(materials[m].name, [&] {
      const auto target = FitTarget(*materials[m].brdf, *problem.network.encoding);
      samples_[m].Add(DrawSamples(*target, SampleSet::kTraining, sampling.Angles(),
                                  sampling.samples, sampling.seed + m));
    });
  });
  for (const EncodedSamples& samples : samples_) {
    objectives_.push_back(MakeObjective(problem, Precision::kSingle, samples, samples.size()));
  }
}

double FamilyObjective::Cost(const FamilyPoint& point) {
  std::vector<double> costs(size());
  ParallelFor(size(), [&](std::size_t m) {
    costs[m] = objectives_[m]->Cost(point.WeightsOf(static_cast<Eigen::Index>(m)).data());
  });
  return std::accumulate(costs.begin(), costs.end(), 0.0);
}

bool FamilyObjective::Linearize(const FamilyPoint& point, CurvaturePart part,
                                FamilyLinearization* at) {
  const Eigen::Index weights = point.weights.rows();
  at->hessians.resize(size());
  at->gradients.resize(weights, point.num_materials());
  std::vector<double> costs(size());
  std::vector<char> is_finite(size());
  ParallelFor(size(), [&](std::size_t m) {
    const auto column = static_cast<Eigen::Index>(m);
    Linearization own;
    is_finite[m] = objectives_[m]->Linearize(point.WeightsOf(column).data(), part, &own);
    if (!is_finite[m]) return;
    costs[m] = own.cost;
    at->hessians[m] =
        Eigen::Map<Eigen::MatrixXd>(own.hessian.data(), weights, weights).cast<float>();
    at->gradients.col(column) = Eigen::Map<Eigen::VectorXd>(own.gradient.data(), weights);
  });
  at->cost = std::accumulate(costs.begin(), costs.end(), 0.0);
  return std::find(is_finite.begin(), is_finite.end(), 0) == is_finite.end();
}

}  // namespace pbnbrdf
