// sampling_lobe.h: the density by which an exported plugin draws directions.
#pragma once

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// With v the direction that is given, wo the one that is drawn, h their half vector:
//
//   pdf = weight G1(v, h) D(h) / (4 cos_v) + (1 - weight) cos_o / pi
//
// the visible normals of a GGX distribution [1] of roughness alpha, isotropic, mixed with a cosine
// lobe.
//
// [1] E. Heitz. Sampling the GGX Distribution of Visible Normals. JCGT 7(4), 2018.
struct SamplingLobe {
  double alpha = 0.5;   // (0, 1]
  double weight = 0.5;  // [0.1, 0.9]: neither lobe is ever left out
};

// The lobe for which the estimator f cos / pdf has the least second moment, summed over some
// incident angles with each one's relative to its squared mean, over a grid of alpha and weight.
// Any lobe gives an unbiased estimate; this one is less noisy.
SamplingLobe FitSamplingLobe(const Brdf& brdf);

}  // namespace pbnbrdf
