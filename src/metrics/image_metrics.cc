#include "pbnbrdf/metrics/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/srgb.h"
#include "metrics/mean.h"
#include "metrics/planes.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/color.h"
#include "pbnbrdf/metrics/flip.h"

namespace pbnbrdf {
namespace {

constexpr double kPercentile = 0.99;

// The mean over all pixels and channels of measure(reference value, test value).
template <typename Measure>
double MeanOfValues(const Image& reference, const Image& test, Measure measure) {
  const std::size_t row = 3 * static_cast<std::size_t>(reference.width);
  const double sum = SumRows(reference.height, [&](int y) {
    double row_sum = 0.0;
    for (std::size_t i = row * std::size_t(y); i < row * std::size_t(y + 1); ++i) {
      row_sum += measure(double(reference.rgb[i]), double(test.rgb[i]));
    }
    return row_sum;
  });
  return sum / static_cast<double>(reference.rgb.size());
}

double Square(double x) { return x * x; }

double MeanSquare(const Image& reference, const Image& test) {
  return MeanOfValues(reference, test, [](double x, double y) { return Square(x - y); });
}

// SSIM, as eqs. 13 to 16 of [1] define it.
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;

// The local mean of x y, where x and y are a channel of the two images.
Plane LocalMean(const Image& x, const Image* y, int channel) {
  Plane plane(x.width, x.height);
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    const std::size_t at = 3 * i + static_cast<std::size_t>(channel);
    plane.values[i] = double(x.rgb[at]) * (y == nullptr ? 1.0 : double(y->rgb[at]));
  }
  const Kernel window = GaussianKernel(kSigma, kSsimWindow / 2);
  return Filter(plane, window, window);
}

double ChannelSsim(const Image& reference, const Image& test, int channel) {
  const Plane mean_x = LocalMean(reference, nullptr, channel);
  const Plane mean_y = LocalMean(test, nullptr, channel);
  const Plane xx = LocalMean(reference, &reference, channel);
  const Plane yy = LocalMean(test, &test, channel);
  const Plane xy = LocalMean(reference, &test, channel);
  constexpr int kMargin = kSsimWindow / 2;
  const int width = reference.width - 2 * kMargin, height = reference.height - 2 * kMargin;
  const double sum = SumRows(height, [&](int row) {
    const int y = row + kMargin;
    double row_sum = 0.0;
    for (int x = kMargin; x < kMargin + width; ++x) {
      const double mx = mean_x.row(y)[x], my = mean_y.row(y)[x];
      const double variances = (xx.row(y)[x] - mx * mx) + (yy.row(y)[x] - my * my);
      const double covariance = xy.row(y)[x] - mx * my;
      row_sum += (2.0 * mx * my + kC1) * (2.0 * covariance + kC2) /
                 ((mx * mx + my * my + kC1) * (variances + kC2));
    }
    return row_sum;
  });
  return sum / (double(width) * double(height));
}

Rgb ColorOf(const float* pixel) { return {pixel[0], pixel[1], pixel[2]}; }

// exposure * value cut to [0, 1].
Image ShownLinear(const Image& image, double exposure) {
  Image shown = image;
  for (float& value : shown.rgb) {
    value = static_cast<float>(std::clamp(exposure * double(value), 0.0, 1.0));
  }
  return shown;
}

double MeanDeltaE(const Image& reference, const Image& test) {
  const double sum = SumRows(reference.height, [&](int y) {
    double row_sum = 0.0;
    for (int x = 0; x < reference.width; ++x) {
      row_sum +=
          DeltaE2000(ToLab(ColorOf(reference.pixel(x, y))), ToLab(ColorOf(test.pixel(x, y))));
    }
    return row_sum;
  });
  return sum / (double(reference.width) * double(reference.height));
}

void CheckFinite(const Image& image, const std::string& name) {
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    if (std::isfinite(image.rgb[i])) continue;
    const std::size_t pixel = i / 3, width = static_cast<std::size_t>(image.width);
    Fail(name, ": ", "RGB"[i % 3], " of pixel (", pixel % width, ", ", pixel / width, ") is ",
         image.rgb[i], "; finite values are needed");
  }
}

}  // namespace

double DisplayExposure(const Image& reference) {
  std::vector<double> luminances(reference.rgb.size() / 3);
  for (std::size_t i = 0; i < luminances.size(); ++i) {
    luminances[i] = Luminance(ColorOf(&reference.rgb[3 * i]));
  }
  std::sort(luminances.begin(), luminances.end());
  const double rank = std::ceil(kPercentile * static_cast<double>(luminances.size()));
  double white = luminances[static_cast<std::size_t>(rank) - 1];
  if (!(white > 0.0)) white = luminances.back();
  return white > 0.0 ? 1.0 / white : 1.0;
}

Image DisplayImage(const Image& image, double exposure) {
  Image shown = image;
  for (float& value : shown.rgb) value = static_cast<float>(ToSrgb(exposure * double(value)));
  return shown;
}

LinearErrors MeasureLinearErrors(const Image& reference, const Image& test) {
  LinearErrors errors;
  errors.mae = MeanOfValues(reference, test, [](double x, double y) { return std::abs(x - y); });
  errors.mse = MeanSquare(reference, test);
  errors.rmse = std::sqrt(errors.mse);
  return errors;
}

double Psnr(const Image& reference, const Image& test) {
  const double mse = MeanSquare(reference, test);
  return mse == 0.0 ? std::numeric_limits<double>::infinity() : -10.0 * std::log10(mse);
}

double Ssim(const Image& reference, const Image& test) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) sum += ChannelSsim(reference, test, c);
  return sum / 3.0;
}

ImageErrors CompareImages(const Image& reference, const Image& test) {
  CheckComparable(reference, test);
  ImageErrors errors;
  errors.exposure = DisplayExposure(reference);
  static_cast<LinearErrors&>(errors) = MeasureLinearErrors(reference, test);

  const Image shown_reference = DisplayImage(reference, errors.exposure);
  const Image shown_test = DisplayImage(test, errors.exposure);
  errors.psnr = Psnr(shown_reference, shown_test);
  errors.ssim = Ssim(shown_reference, shown_test);

  const Image linear_reference = ShownLinear(reference, errors.exposure);
  const Image linear_test = ShownLinear(test, errors.exposure);
  errors.flip = Mean(FlipMap(linear_reference, linear_test));
  errors.delta_e_2000 = MeanDeltaE(linear_reference, linear_test);
  errors.hdr_flip = Mean(HdrFlipMap(reference, test));
  return errors;
}

void CheckComparable(const Image& reference, const Image& test, const std::string& reference_name,
                     const std::string& test_name) {
  if (reference.width != test.width || reference.height != test.height) {
    Fail(test_name, ": ", test.width, " x ", test.height, " pixels, but ", reference_name, " has ",
         reference.width, " x ", reference.height);
  }
  if (reference.width < kSsimWindow || reference.height < kSsimWindow) {
    Fail(reference_name, ": ", reference.width, " x ", reference.height,
         " pixels; SSIM needs at least ", kSsimWindow, " x ", kSsimWindow);
  }
  CheckFinite(reference, reference_name);
  CheckFinite(test, test_name);
}

Image AbsoluteDifference(const Image& reference, const Image& test) {
  Image difference = test;
  for (std::size_t i = 0; i < test.rgb.size(); ++i) {
    difference.rgb[i] = std::abs(test.rgb[i] - reference.rgb[i]);
  }
  return difference;
}

}  // namespace pbnbrdf
