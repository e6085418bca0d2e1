// tiles.h: the tiles of an image, and which of them show nothing but the environment.
#pragma once

#include <vector>

#include "camera.h"
#include "pixels.h"

namespace pbnbrdf {

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
