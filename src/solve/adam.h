// adam.h: Adam [1] on minibatches of the papers' own loss (Loss::kAbsolute): the published recipe,
// as the baseline.
//
// [1] D. Kingma, J. Ba. Adam: A Method for Stochastic Optimization. ICLR 2015.
#pragma once

#include "problem/encoded_samples.h"
#include "solve/stage.h"

namespace pbnbrdf {

// An iteration is an epoch: every sample once, in random order (the problem's seed). The
// loss is Loss::kAbsolute, of all terms from the start; the energy term takes random incident angles at
// each step, on a grid of energy_theta x energy_phi half vectors.
//
// The cost is that of `objective`, over some of the training samples. From epoch to epoch it is noisy;
// converged means that its mean over 5 epochs differs from that over the 5 before by less than a
// part of function_tolerance. weights: where to start, and on return and in callbacks those of the
// epoch with the least cost; the published scripts keep the last, which is a tenth worse or more at
// random. Diverged where the cost or a weight isn't finite any more.
StageResult MinimizeAdam(const FitProblem& problem, const EncodedSamples& samples,
                         const AdamOptions& adam, Objective* objective, const StageOptions& options,
                         std::vector<double>* weights);

}  // namespace pbnbrdf
