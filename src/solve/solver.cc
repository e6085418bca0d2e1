#include "solve/solver.h"

namespace pbnbrdf {
namespace {

constexpr int kMaxSecondOrderWeights = 10000;  // J'J then has 800 MB
constexpr int kMaxLmWeights = 2500;            // a fit takes up to 370 MB

constexpr Solver kSolvers[] = {
    {"lm",
     "Levenberg-Marquardt on the normal equations",
     {.splits_curvature = true, .max_weights = kMaxLmWeights, .wide_solver = "ceres_lbfgs"},
     MinimizeLm},
    {"ceres_lm",
     "Ceres' own, with the same steps",
     {.max_weights = kMaxSecondOrderWeights},
     MinimizeCeresLm},
    {"ceres_lbfgs", "Ceres' L-BFGS", {.needs_squares = false, .pace = 10}, MinimizeCeresLbfgs},
    {"adam",
     "Adam on minibatches, as published",
     {.needs_squares = false, .is_stochastic = true},
     MinimizeAdam},
    {"autodiff",
     "ceres_lm on jets through the whole network: the slow reference",
     {.max_weights = kMaxSecondOrderWeights},
     MinimizeAutodiff},
};

}  // namespace

std::span<const Solver> Solvers() { return kSolvers; }

const Solver& FindSolver(std::string_view name) { return FindNamed(kSolvers, "solver=", name); }

}  // namespace pbnbrdf
