// sky.h: environment maps that need no file.
#pragma once

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// Radiance, W / (m^2 sr). Above the horizon it is linear in y, the cosine of the zenith angle, from
// `horizon` to `zenith`. Below it is `ground`. The sun is a disk.
struct Sky {
  Rgb zenith = {}, horizon = {}, ground = {}, sun = {};
  Vec3 sun_direction = {0.0, 1.0, 0.0};  // to the sun, of unit length
  double sun_radius = 0.0;               // angular, degrees; 0: no sun
};

// The sky as an environment map, 1024 x 512. A texel is the mean of 4 x 4 directions.
Image SkyImage(const Sky& sky);

// One texel, for the same radiance from everywhere.
Image ConstantImage(const Rgb& radiance);

}  // namespace pbnbrdf
