// camera.h: a scene's pinhole camera, from pixels to rays and from points to pixels, and the tiles of its
// image.
#pragma once

#include <vector>

#include "geometry.h"
#include "pixels.h"

namespace pbnbrdf {

// Where a point is seen, in pixels from the left and the top of the image, perhaps outside of it. Rays
// that hit the point pass the image within `slack` pixels of there.
struct Projection {
  double x, y, slack;
};

class PinholeCamera {
 public:
  PinholeCamera(const Camera& camera, const Film& film);

  // The ray through a place in the image, in pixels from its left and top.
  Ray RayThrough(double x, double y) const;

  // The error of rays in pixels: one, and what single precision of their directions adds.
  double Slack() const;

  // False if the point is behind the camera, or so far to the side that it may be.
  bool Project(const Vec3& point, Projection* projection) const;

 private:
  Film film_;
  Vec3 origin_, forward_;
  Vec3 right_, up_;  // half of the image's sides at distance 1
};

struct Tile {
  PixelBlock block;
  bool empty;  // no ray through it hits a shape or a rectangle light
};

inline constexpr int kTileSize = 16;  // as pbrt's

// The tiles, row by row. Conservative: a tile that is not called empty may be. A mesh is bounded by a
// rectangle of the image, or by all of it if a vertex is not in front of the camera; a sphere by the
// cone in which the camera sees it; both enlarged by a pixel.
std::vector<Tile> TilesOf(const Scene& scene, const PinholeCamera& camera);

}  // namespace pbnbrdf
