// adam.h: Adam [1] on minibatches of the papers' own loss (Loss::kAbsolute): the published recipe,
// as the baseline.
//
// [1] D. Kingma, J. Ba. Adam: A Method for Stochastic Optimization. ICLR 2015.
#pragma once

#include <span>

#include "pbnbrdf/problem/fit_problem.h"
#include "solve/stage.h"

namespace pbnbrdf {

// NBRDF's settings (Sztrajman et al. 2021) are the defaults.
struct AdamOptions {
  std::size_t batch = 512;      // samples a step, >= 1; an epoch's last, smaller batch is left out
  double learning_rate = 5e-4;  // > 0
  int energy_angles = 2;        // incident angles a step of the energy term, 1 to 1024

  // Throws Error, naming the field, its value and what it must be.
  void Validate() const;
};

// An iteration is an epoch: every sample once, in random order (problem.seed). The loss is
// Loss::kAbsolute whatever problem.loss says, of all terms from the start; the energy term takes
// random incident angles at each step, on a grid of energy_theta x energy_phi half vectors.
//
// The cost is that of Objective over some of the training samples. From epoch to epoch it is noisy;
// converged means that its mean over 5 epochs differs from that over the 5 before by less than a
// part of function_tolerance. weights: where to start, and on return and in callbacks those of the
// epoch with the least cost; the published scripts keep the last, which is a tenth worse or more at
// random. Diverged where the cost or a weight isn't finite any more.
StageResult MinimizeAdam(const FitProblem& problem, std::span<const BrdfSample> samples,
                         const AdamOptions& adam, const StageOptions& options,
                         std::vector<double>* weights);

}  // namespace pbnbrdf
