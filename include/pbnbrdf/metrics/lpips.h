// lpips.h: LPIPS, how different two images look, by features of a network that recognises images [1].
//
// Version 0.1 with the features of AlexNet [2], as its authors' Python package lpips has it (0.1.4;
// the convolutions are torchvision's). Features are made unit vectors over the channels at each
// position; the distance of a layer is the mean over the positions of the weighted squared
// differences, and LPIPS the sum over five layers. The weights aren't part of this library.
//
// [1] R. Zhang, P. Isola, A. Efros, E. Shechtman, O. Wang. The Unreasonable Effectiveness of Deep
//     Features as a Perceptual Metric. CVPR 2018.
// [2] A. Krizhevsky. One Weird Trick for Parallelizing Convolutional Neural Networks. 2014.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// A convolution of kernel x kernel windows, every `stride` positions, zeros `padding` wide around the
// input; what follows is max(0, value). If `pooled`, its input is the layer before, of which the
// largest values of windows of 3 x 3, every other position, are taken.
struct LpipsLayerShape {
  int inputs, units, kernel, stride, padding;
  bool pooled;
};

inline constexpr std::array<LpipsLayerShape, 5> kLpipsLayers = {{
    {.inputs = 3, .units = 64, .kernel = 11, .stride = 4, .padding = 2, .pooled = false},
    {.inputs = 64, .units = 192, .kernel = 5, .stride = 1, .padding = 2, .pooled = true},
    {.inputs = 192, .units = 384, .kernel = 3, .stride = 1, .padding = 1, .pooled = true},
    {.inputs = 384, .units = 256, .kernel = 3, .stride = 1, .padding = 1, .pooled = false},
    {.inputs = 256, .units = 256, .kernel = 3, .stride = 1, .padding = 1, .pooled = false},
}};

// Of a layer of kLpipsLayers, finite.
struct LpipsLayer {
  std::vector<double> kernels;  // units x inputs x kernel (rows) x kernel (columns), row-major
  std::vector<double> biases;   // units
  std::vector<double> head;     // units: what a squared difference of each counts
};
using LpipsWeights = std::array<LpipsLayer, kLpipsLayers.size()>;

// The smallest side of images that LPIPS is defined for: 31 pixels make 7 positions of the first
// layer, 3 of the second and 1 of the others.
inline constexpr int kMinLpipsSide = 31;

// Throws Error, which begins with the name, if a side of the image is shorter than that.
void CheckLargeEnoughForLpips(const Image& image, const std::string& name);

// LPIPS of two display images (image_metrics.h: sRGB in [0, 1]) of the same size; 0 if they are equal.
// Sums are in double precision. Throws Error if the images are too small or the weights so large that
// the result isn't finite.
double Lpips(const Image& reference, const Image& test, const LpipsWeights& weights);

}  // namespace pbnbrdf
