// tiles.h: the parts of the image that are rendered at a time, and which of them show shapes.
#pragma once

#include <vector>

#include "camera.h"
#include "pbnbrdf/render/scene.h"

namespace pbnbrdf {

struct PixelBlock {
  int x, y, width, height;
};

struct Tile {
  PixelBlock block;
  bool empty;  // no ray through it meets a shape or a rectangle light
};

inline constexpr int kTileSize = 16;

// Row by row. A mesh is taken for the rectangle about its points in the image, and for everywhere if
// one of them isn't in front of the camera; a sphere for the cone in which it is seen. Both with a
// pixel of slack: tiles that aren't called empty may yet be.
std::vector<Tile> TilesOf(const Scene& scene, const PinholeCamera& camera);

// The block cut into squares of the given size; those at its right and bottom may be smaller.
std::vector<PixelBlock> Cut(const PixelBlock& block, int size);

}  // namespace pbnbrdf
