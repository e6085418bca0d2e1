// light_set.h: an environment as a few lights, for a shader that asks the material at each of them.
#pragma once

#include <functional>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

struct DistantLight {
  Vec3 direction;  // to the light, of unit length
  Rgb irradiance;  // W/m^2, on a surface that faces it
};

// All of an environment's light: each direction's goes to the nearest of `count` directions that are spread evenly
// over the sphere (a Fibonacci lattice), and each light stands where the light that it has got comes from, in the
// mean. radiance: W / (m^2 sr).
std::vector<DistantLight> LightSet(const std::function<Rgb(const Vec3&)>& radiance, int count);

}  // namespace pbnbrdf
