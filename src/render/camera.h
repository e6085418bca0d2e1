// camera.h: a scene's camera, from pixels to rays and from points to pixels.
#pragma once

#include "geometry.h"
#include "pbnbrdf/render/scene.h"

namespace pbnbrdf {

// Where a point is seen, in pixels from the left and the top of the image, which it may be outside
// of. Rays that meet the point pass the image within `slack` of there.
struct Projection {
  double x, y, slack;
};

class PinholeCamera {
 public:
  PinholeCamera(const Camera& camera, const Film& film);

  // Through the place in the image, in pixels from its left and top.
  Ray RayThrough(double x, double y) const;

  // Rays through the image are within so many pixels of where they should be: one, and what their
  // directions are off by in single precision.
  double Slack() const;

  // False if the point is behind the camera, or so far to the side that it may be.
  bool Project(const Vec3& point, Projection* projection) const;

 private:
  Film film_;
  Vec3 origin_, forward_;
  Vec3 right_, up_;  // the image's half sides at distance 1
};

}  // namespace pbnbrdf
