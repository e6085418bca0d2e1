#include "solve/solver.h"

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/problem/ceres_problem.h"
#include "solve/adam.h"
#include "solve/ceres_solvers.h"
#include "solve/lm.h"

namespace pbnbrdf {
namespace {

constexpr int kMaxSecondOrderWeights = 10000;  // J'J then has 800 MB

StageResult RunLm(const StageInput& input, const StageOptions& options,
                  std::vector<double>* weights) {
  return MinimizeLm(input.objective, options, weights);
}

StageResult RunCeresLm(const StageInput& input, const StageOptions& options,
                       std::vector<double>* weights) {
  ceres::Problem problem;
  AddCondensed(input.objective, weights->data(), &problem);
  return MinimizeCeresLm(&problem, options);
}

StageResult RunAutodiff(const StageInput& input, const StageOptions& options,
                        std::vector<double>* weights) {
  ceres::Problem problem;
  AddAutodiff(input.problem, input.samples.first(input.objective->num_samples()), input.strata,
              weights->data(), &problem);
  return MinimizeCeresLm(&problem, options);
}

StageResult RunCeresLbfgs(const StageInput& input, const StageOptions& options,
                          std::vector<double>* weights) {
  return MinimizeCeresLbfgs(input.objective, options, weights);
}

StageResult RunAdam(const StageInput& input, const StageOptions& options,
                    std::vector<double>* weights) {
  return MinimizeAdam(input.problem, input.samples, input.options.adam, input.objective, options,
                      weights);
}

constexpr Solver kSolvers[] = {
    {"lm",
     "Levenberg-Marquardt on the normal equations",
     {.splits_curvature = true, .max_weights = kMaxSecondOrderWeights},
     RunLm},
    {"ceres_lm",
     "Ceres' own, with the same steps",
     {.max_weights = kMaxSecondOrderWeights},
     RunCeresLm},
    {"ceres_lbfgs", "Ceres' L-BFGS", {.needs_squares = false, .pace = 10}, RunCeresLbfgs},
    {"adam",
     "Adam on minibatches, as published",
     {.needs_squares = false, .is_stochastic = true},
     RunAdam},
    {"autodiff",
     "ceres_lm on jets through the whole network: the slow reference",
     {.max_weights = kMaxSecondOrderWeights},
     RunAutodiff},
};

}  // namespace

std::span<const Solver> Solvers() { return kSolvers; }

const Solver& FindSolver(std::string_view name) {
  std::string names;
  for (const Solver& solver : kSolvers) {
    if (solver.name == name) return solver;
    names += StrCat(names.empty() ? "" : " | ", solver.name);
  }
  Fail("solver=", name, " is not one of ", names);
}

}  // namespace pbnbrdf
