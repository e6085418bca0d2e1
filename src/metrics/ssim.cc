// SSIM, as eqs. 13 to 16 of Wang et al. 2004 define it.
#include "metrics/planes.h"
#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {
namespace {

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

}  // namespace

double Ssim(const Image& reference, const Image& test) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) sum += ChannelSsim(reference, test, c);
  return sum / 3.0;
}

}  // namespace pbnbrdf
