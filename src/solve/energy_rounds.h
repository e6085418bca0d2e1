// energy_rounds.h: the stages of a fit in which the energy term (eq. 5) takes part.
#pragma once

#include "solve/training.h"

namespace pbnbrdf {

// Brings all directional albedos to at most 1, by the energy term and, what that leaves undone, by
// lowering the network as a whole. problem: with the energy term's weight to begin with.
void ConserveEnergy(const FitProblem& problem, Training* training);

}  // namespace pbnbrdf
