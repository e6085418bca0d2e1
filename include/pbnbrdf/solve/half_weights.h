// half_weights.h: a network whose weights are numbers of half precision, for shaders: half the memory.
#pragma once

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

struct HalfWeights {
  NeuralBrdf network;  // its metadata says what it differs by ("half_precision")
  // Of |difference| / (1 + f) to the network before, over directions, dense near the mirror direction, and channels:
  // the mean, and what 99 % don't exceed.
  double mean_change = 0.0, most_change = 0.0;
  double max_albedo = 0.0;  // the largest directional albedo
};

// The network with all weights rounded to half precision: normal numbers, up to 65504. Rounded one by one they make
// several times the error of the fit, as a fit's weights are large and cancel each other. Here some are rounded at a
// time, and those that are still free then make good for it, as in optimal brain compression [1]. What conserves energy
// still does. Takes some ten seconds for 675 weights; time and memory grow as the cube and the square of their number.
//
// Throws Error if a weight is beyond half precision, or the network has more than 5000 weights.
//
// [1] E. Frantar, D. Alistarh. Optimal Brain Compression: A Framework for Accurate Post-Training Quantization and
//     Pruning. NeurIPS 2022, arXiv:2208.11580.
HalfWeights ToHalfWeights(const NeuralBrdf& network);

}  // namespace pbnbrdf
