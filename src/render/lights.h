// lights.h: the lights of a scene, as a path meets or samples them.
#pragma once

#include "pbnbrdf/render/render.h"
#include "random.h"

namespace pbnbrdf {

struct LightSample {
  Vec3 direction;   // to the light, of unit length
  double distance;  // nothing nearer may be in between; may be infinite
  Rgb weight;       // radiance over the density, or what a point or directional light has for it
  double pdf;       // per solid angle, with the choice of the light; 0: no other way finds it
};

class Lights {
 public:
  // The scene must outlive this.
  Lights(const Scene& scene, Estimator estimator);

  // A light at random and a direction to it, of weight 0 if nothing comes from there; false if there
  // is no light, or it is at the very position.
  bool Sample(const Vec3& position, Random* random, LightSample* sample) const;

  // What comes from a direction in which nothing is, and the density that Sample has for it.
  Rgb EnvironmentRadiance(const Vec3& direction) const;
  double EnvironmentPdf(const Vec3& direction) const;

  // What a ray from `origin` finds where it hits the rectangle, and the density as above.
  Rgb RectangleRadiance(int light, const Vec3& direction) const;
  double RectanglePdf(int light, const Vec3& origin, const Vec3& direction,
                      const Vec3& position) const;

 private:
  enum class Kind { kEnvironment, kRectangle, kPoint, kDirectional };
  struct Choice {
    Kind kind;
    std::size_t number;
  };

  bool SampleRectangle(const RectangleLight& light, const Vec3& position, Random* random,
                       LightSample* sample) const;

  const Scene& scene_;
  std::vector<Choice> choices_;
};

}  // namespace pbnbrdf
