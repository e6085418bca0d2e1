// flip.h: the FLIP difference of two images: what people see when one takes the other's place [1, 2].
//
// 0 where nothing is seen, 1 at most. Seen from where a degree of the field of view holds
// kFlipPixelsPerDegree pixels: a screen 3840 pixels and 0.7 m wide, from 0.7 m. Symmetric, but for the
// exposures of HDR-FLIP, which are those of the reference.
//
// [1] P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. Fairchild. FLIP: A
//     Difference Evaluator for Alternating Images. High Performance Graphics 2020.
// [2] P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moeller. Visualizing Errors in Rendered High
//     Dynamic Range Images. Eurographics 2021.
#pragma once

#include <numbers>
#include <vector>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

inline constexpr double kFlipPixelsPerDegree = 3840.0 * std::numbers::pi / 180.0;  // 67.02

// FLIP of each pixel, rows from the top, of images for a screen: linear RGB, cut to [0, 1]. Both have
// the same size and finite values.
std::vector<double> FlipMap(const Image& reference, const Image& test);

// The exposures, as powers of 2, at which HDR-FLIP looks at images, evenly spaced: from that where
// the reference's largest luminance to that where its median is shown at 0.85 by the ACES tone curve.
struct FlipExposures {
  double first = 0.0, last = 0.0;
  int count = 2;
};

// The median counts as at least 2^-23; 0 to 0 for a reference without a positive luminance.
FlipExposures ReferenceExposures(const Image& reference);

// HDR-FLIP of each pixel: the largest FLIP over the exposures, after the ACES tone curve. Linear RGB, finite, of
// the same size. Negative values are shown as the curve's formula has it, far negative ones bright, as [2]'s authors'
// program does.
std::vector<double> HdrFlipMap(const Image& reference, const Image& test);

}  // namespace pbnbrdf
