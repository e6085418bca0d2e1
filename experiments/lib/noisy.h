// noisy.h: formulas as instruments would measure them: with noise, as a table or as a list.
#pragma once

#include <cstdint>
#include <span>

#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/sources/merl.h"

namespace pbnbrdf {

// f becomes f (1 + m a) + s b, a and b independent normal deviates of each channel.
struct Noise {
  double multiplicative = 0.0;  // m >= 0
  double additive = 0.0;        // s >= 0, 1/sr
};

// A MERL table of an isotropic formula whose valid bins have noise, negative ones included. Throws Error as
// MerlBrdf::Tabulate does.
MerlBrdf NoisyTable(const Brdf& clean, const Noise& noise, std::uint64_t seed);

// A list of `count` measurements at directions uniform in solid angle, those of wi within 80 degrees.
ScatteredBrdf NoisyMeasurements(const Brdf& clean, std::size_t count, const Noise& noise,
                                std::uint64_t seed);

// How much too bright a fit is where the material is dark: (sum of its values) / (sum of the material's) - 1
// over the half of the samples with the smaller values, in the channel where that is farthest from 0.
double DarkHalfBias(std::span<const BrdfSample> samples, const Brdf& fit);

}  // namespace pbnbrdf
