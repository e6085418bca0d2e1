// image_metrics.h: how far a test image is from a reference, by the measures of the field.
//
// MAE, MSE and RMSE are of the linear values as they are. HDR-FLIP (flip.h) chooses its own exposures.
// The others are of the images as a screen shows them: multiplied by one exposure, which the reference
// gives to both (DisplayExposure), and cut to [0, 1]. PSNR and SSIM take what sRGB makes of that
// (image/srgb.h), channel by channel. Nothing is rounded to 8 bits.
//
// [1] Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli. Image Quality Assessment: From Error Visibility to
//     Structural Similarity. IEEE Transactions on Image Processing 13(4), 2004.
#pragma once

#include <string>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// 1 / the reference's 99th percentile of luminance (that of rank ceil(0.99 n) in ascending order), so
// that all but a hundredth of the pixels are at most white. If that isn't positive, 1 / the largest
// luminance; if that isn't either, 1.
double DisplayExposure(const Image& reference);

// sRGB(exposure * value), the product cut to [0, 1].
Image DisplayImage(const Image& image, double exposure);

// Means over all pixels and channels of the linear values; rmse is the root of mse.
struct LinearErrors {
  double mae = 0.0, mse = 0.0, rmse = 0.0;
};
LinearErrors MeasureLinearErrors(const Image& reference, const Image& test);

// -10 log10(MSE) of two display images, in dB; infinite if they are equal.
double Psnr(const Image& reference, const Image& test);

// The smallest side of images that SSIM is defined for.
inline constexpr int kSsimWindow = 11;

// Mean SSIM [1] of two display images: Gaussian window of kSsimWindow^2 pixels, sigma 1.5, K1 = 0.01,
// K2 = 0.03, range 1, over the windows that lie inside of the image; the mean of the channels. At most
// 1, that for equal images.
double Ssim(const Image& reference, const Image& test);

struct ImageErrors : LinearErrors {
  double exposure = 0.0;  // DisplayExposure
  double psnr = 0.0;      // dB; infinite where the display images are equal
  double ssim = 0.0;
  double flip = 0.0, hdr_flip = 0.0;  // means of the maps of flip.h
  double delta_e_2000 = 0.0;          // mean CIE Delta E 2000 (color.h) of the shown colours
};

// All of the above. Throws Error as CheckComparable does.
ImageErrors CompareImages(const Image& reference, const Image& test);

// Throws Error unless both have the same size, at least kSsimWindow^2, and finite values; the names
// are those that the message uses.
void CheckComparable(const Image& reference, const Image& test,
                     const std::string& reference_name = "the reference",
                     const std::string& test_name = "the test image");

// |test - reference|, linear. Same size.
Image AbsoluteDifference(const Image& reference, const Image& test);

}  // namespace pbnbrdf
