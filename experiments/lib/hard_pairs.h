// hard_pairs.h: direction pairs at which encodings and networks are hardest to evaluate.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// theta_h and theta_d at 0 and pi/2 exactly, phi_d at the quarters of a turn.
std::vector<DirectionPair> CornerPairs();

// These, others next to them, wi = wo, wi = -wo, grazing and below the horizon.
std::vector<DirectionPair> HardPairs();

}  // namespace pbnbrdf
