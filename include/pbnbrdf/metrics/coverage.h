// coverage.h: what the data of a material are: how much of the hemisphere was measured, and how well.
#pragma once

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

struct Coverage {
  // The part of all pairs of directions above the horizon, both uniform in solid angle, at which it is known
  // (Brdf::IsKnown): near a measurement, if it is a list of them. Within 0.01.
  double known = 1.0;
  // Whether it is a list of measurements with both directions always in one plane with the normal.
  bool in_plane = false;
  // The part of the measurements, or of the known pairs, at which a channel is below 0.
  double negative = 0.0;
  // By how much neighbours differ: the standard deviation of noise (1/sr) that this would be, so that noise is
  // at most that in the median. Neighbours are a measurement and the nearest one to it, or values two degrees
  // of phi_d apart, twice the spacing of a MERL table, and the one between them.
  double noise = 0.0;
  // The largest of the measurements, or of the values at known pairs and in mirror directions, with both directions
  // within 60 degrees of the normal; 1/sr. 0 if there are none.
  double largest = 0.0;
};

Coverage MeasureCoverage(const Brdf& material);

}  // namespace pbnbrdf
