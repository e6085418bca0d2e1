// lobe_widths.h: how wide a lobe is along x and along y.
#pragma once

#include <string>

namespace pbnbrdf {

// Widths > 0 of a lobe along x and y; one number: the same all around, which makes it isotropic.
struct LobeWidths {
  LobeWidths(double width) : x(width), y(width) {}  // NOLINT: a number is meant to convert
  LobeWidths(double along_x, double along_y) : x(along_x), y(along_y) {}

  bool AreEqual() const { return x == y; }
  // "alpha 0.1", or "alpha_x 0.1, alpha_y 0.3"
  std::string Description() const;

  double x, y;
};

}  // namespace pbnbrdf
