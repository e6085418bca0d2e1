// lights.h: the lights of a scene, as paths sample them and as rays hit them.
#pragma once

#include "geometry.h"
#include "pbnbrdf/render/render.h"
#include "random.h"

namespace pbnbrdf {

struct LightSample {
  Vec3 direction;   // to the light, of unit length
  double distance;  // the light is seen if nothing is nearer; may be infinite
  Rgb weight;       // radiance / pdf; of a point or directional light, irradiance / probability
  double pdf;       // per solid angle, times the probability of the light; 0: no ray can hit it
};

class Lights {
 public:
  // The scene must outlive this.
  Lights(const Scene& scene, Estimator estimator);

  // Chooses a light at random and a direction to it. The weight is 0 if no light comes from there.
  // False if there is no light, or if it is at the position itself.
  bool Sample(const Vec3& position, Random* random, LightSample* sample) const;

  // Of a ray that hits a rectangle light, or the environment if `hit` is null: the radiance that it
  // finds, and the density with which Sample would have chosen its direction.
  Rgb Radiance(const Ray& ray, const Hit* hit) const;
  double Pdf(const Ray& ray, const Hit* hit) const;

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

// Weight of a sample in multiple importance sampling: the power heuristic with exponent 2. pdf: of
// the technique that drew it; other: of the other technique for the same direction.
inline double PowerHeuristic(double pdf, double other) {
  const double ratio = other / pdf;
  return 1.0 / (1.0 + ratio * ratio);
}

}  // namespace pbnbrdf
