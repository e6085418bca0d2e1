// measured_samples.h: what fits of measured materials are measured on, and what else they are compared with.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// Of one of a material's IncidentAngles(): its measurements there or, of a source that isn't a list of
// them, `count` samples with theta_h uniform up to 90 degrees and any azimuth, where the material is known.
std::vector<BrdfSample> SamplesAtAngle(const Brdf& material, double theta_i, std::size_t count);

// What was measured: the measurements that no fit sees, if the material is a list of them; SamplesAtAngle
// of each of IncidentAngles() at which the material is known, `count` of each; HeldOutSamples, `count` of
// them, of a material that has neither.
std::vector<BrdfSample> SamplesAtMeasured(const Brdf& material, std::size_t count);

// The least mean absolute log error of any reciprocal fit on samples of the material (ReciprocalFloor). Of a
// list of measurements it is half the mean difference of those at the same place, repeated or reciprocal
// (scattered.h); NaN if there are no two.
double MeasuredFloor(const Brdf& material, std::span<const BrdfSample> samples);

// What a material is between its measurements without any fit: the nearest measurement, as near is meant in
// scattered.h with both signs of phi_d alike, if it is a list of them; else the source's own interpolation.
std::unique_ptr<Brdf> PlainInterpolation(const Brdf& material);

// The material as its source interpolates it, at all angles alike, without the measurements that no fit
// sees: what published recipes are trained on.
std::unique_ptr<Brdf> AsInterpolated(const Brdf& material);

}  // namespace pbnbrdf
