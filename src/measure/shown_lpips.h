// shown_lpips.h: LPIPS of rendered images, with the weights of a file.
#pragma once

#include <string>

#include "pbnbrdf/image/image.h"
#include "pbnbrdf/metrics/lpips.h"

namespace pbnbrdf {

class ShownLpips {
 public:
  // Reads a safetensors file of F32 or F64 tensors named as in the state of the Python package lpips (its
  // LPIPS(net='alex')): net.slice1.0.weight, net.slice1.0.bias, ..., lin4.model.1.weight; others are ignored.
  // Throws Error as ReadSafetensors does, and if one is missing or of another shape.
  explicit ShownLpips(const std::string& file);

  // Of what a screen shows of two linear images at an exposure (image_metrics.h). Throws Error as Lpips does.
  double Of(const Image& reference, const Image& test, double exposure) const;

 private:
  std::string file_;
  LpipsWeights weights_;
};

}  // namespace pbnbrdf
