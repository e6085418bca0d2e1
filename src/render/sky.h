// sky.h: a simple sky, for scenes that come without a measured one.
#pragma once

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// Radiance, W / (m^2 sr). Above the horizon it goes from `horizon` to `zenith` in proportion to y,
// the cosine of the zenith angle; below it is `ground`. The sun is a disk.
struct Sky {
  Rgb zenith = {}, horizon = {}, ground = {}, sun = {};
  Vec3 sun_direction = {0.0, 1.0, 0.0};  // of unit length, towards the sun
  double sun_radius = 0.0;               // as seen, degrees; 0: no sun
};

// As an environment map takes it, 1024 x 512; each texel holds the mean of 4 x 4 directions.
Image SkyImage(const Sky& sky);

}  // namespace pbnbrdf
