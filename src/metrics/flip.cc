#include "pbnbrdf/metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/pi.h"
#include "metrics/planes.h"
#include "pbnbrdf/metrics/color.h"

namespace pbnbrdf {
namespace {

// Luminance, red-green and blue-yellow, a plane each, in which white is 1, 0 and 0. The published scales and
// offsets of YCxCz cancel, as the filters' weights add up to 1.
using Opponents = std::array<Plane, 3>;

Opponents ToOpponents(const Image& image) {
  Opponents planes = {Plane(image.width, image.height), Plane(image.width, image.height),
                      Plane(image.width, image.height)};
  const std::array<double, 3> white = ToXyz({1.0, 1.0, 1.0});
  ForEachRow(image.height, [&](int row) {
    for (int x = 0; x < image.width; ++x) {
      Rgb linear;
      for (int c = 0; c < 3; ++c) linear[c] = std::clamp(double(image.pixel(x, row)[c]), 0.0, 1.0);
      const std::array<double, 3> xyz = ToXyz(linear);
      const double y = xyz[1] / white[1];
      planes[0].row(row)[x] = y;
      planes[1].row(row)[x] = xyz[0] / white[0] - y;
      planes[2].row(row)[x] = y - xyz[2] / white[2];
    }
  });
  return planes;
}

// What people still resolve of an opponent channel, as a sum of Gaussians
// a sqrt(pi / b) exp(-pi^2 (x^2 + y^2) / b), x and y in degrees.
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kLuminance = {1.0, 0.0047}, kRedGreen = {1.0, 0.0053};
constexpr Sensitivity kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

// In pixels: three standard deviations of the widest.
int SensitivityRadius() {
  const double sigma = std::sqrt(kBlueYellow[0].b / (2.0 * kPi * kPi));
  return static_cast<int>(std::ceil(3.0 * sigma * kFlipPixelsPerDegree));
}

// The standard deviation in pixels.
double SigmaOf(const Sensitivity& s) {
  return std::sqrt(s.b / (2.0 * kPi * kPi)) * kFlipPixelsPerDegree;
}

Plane Blur(const Plane& plane, const Sensitivity& s) {
  const Kernel kernel = GaussianKernel(SigmaOf(s), SensitivityRadius());
  return Filter(plane, kernel, kernel);
}

// The sum of the Gaussian's weights before they are scaled to 1.
double Mass(const Sensitivity& s) {
  double sum = 0.0;
  const double sigma = SigmaOf(s);
  for (int x = -SensitivityRadius(); x <= SensitivityRadius(); ++x) {
    sum += std::exp(-0.5 * x * x / (sigma * sigma));
  }
  return s.a * std::sqrt(kPi / s.b) * sum * sum;
}

Opponents BlurAsSeen(const Opponents& planes) {
  Plane blue_yellow = Blur(planes[2], kBlueYellow[0]);
  const Plane narrow = Blur(planes[2], kBlueYellow[1]);
  const double wide_mass = Mass(kBlueYellow[0]), narrow_mass = Mass(kBlueYellow[1]);
  const double share = wide_mass / (wide_mass + narrow_mass);
  for (std::size_t i = 0; i < narrow.values.size(); ++i) {
    blue_yellow.values[i] = share * blue_yellow.values[i] + (1.0 - share) * narrow.values[i];
  }
  return {Blur(planes[0], kLuminance), Blur(planes[1], kRedGreen), std::move(blue_yellow)};
}

// CIELAB with the Hunt effect: chroma grows with lightness.
Lab HuntLab(const Rgb& linear) {
  Lab lab = ToLab(linear);
  lab.a *= 0.01 * lab.l;
  lab.b *= 0.01 * lab.l;
  return lab;
}

Lab SeenColor(const Opponents& planes, std::size_t i) {
  const std::array<double, 3> white = ToXyz({1.0, 1.0, 1.0});
  const double y = planes[0].values[i];
  const std::array<double, 3> xyz = {white[0] * (y + planes[1].values[i]), white[1] * y,
                                     white[2] * (y - planes[2].values[i])};
  Rgb linear = FromXyz(xyz);
  for (int c = 0; c < 3; ++c) linear[c] = std::clamp(linear[c], 0.0, 1.0);
  return HuntLab(linear);
}

double HyAb(const Lab& x, const Lab& y) { return std::abs(x.l - y.l) + HueChromaDifference(x, y); }

// Maps a distance to [0, 1]. Small, common distances take the part from 0 to kShare.
double ColorError(double distance, double largest) {
  constexpr double kExponent = 0.7, kKnee = 0.4, kShare = 0.95;
  const double most = std::pow(largest, kExponent), error = std::pow(distance, kExponent);
  const double knee = kKnee * most;
  return error < knee ? kShare * error / knee
                      : kShare + (1.0 - kShare) * (error - knee) / (most - knee);
}

// The Gaussian's first or second derivative across, with its positive weights scaled to the sum 1
// and its negative ones to the sum -1.
Kernel DerivativeKernel(double sigma, int radius, int order) {
  Kernel kernel = GaussianKernel(sigma, radius);
  double positive = 0.0, negative = 0.0;
  for (int x = -radius; x <= radius; ++x) {
    double& weight = kernel[static_cast<std::size_t>(x + radius)];
    weight *= order == 1 ? -x : x * x / (sigma * sigma) - 1.0;
    (weight > 0.0 ? positive : negative) += std::abs(weight);
  }
  for (double& weight : kernel) weight /= weight > 0.0 ? positive : negative;
  return kernel;
}

// How strongly edges (order 1) or points and lines (order 2) show at each pixel.
Plane FeatureStrength(const Plane& luminance, int order) {
  constexpr double kFeatureWidth = 0.082;  // of an edge that is seen best, degrees
  const double sigma = 0.5 * kFeatureWidth * kFlipPixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const Kernel smooth = GaussianKernel(sigma, radius);
  const Kernel derivative = DerivativeKernel(sigma, radius, order);
  Plane strength = Filter(luminance, derivative, smooth);
  const Plane down = Filter(luminance, smooth, derivative);
  for (std::size_t i = 0; i < down.values.size(); ++i) {
    strength.values[i] = std::hypot(strength.values[i], down.values[i]);
  }
  return strength;
}

double FeatureError(double edges, double points) {
  return std::sqrt(std::max(std::abs(edges), std::abs(points)) / std::numbers::sqrt2);
}

// What FLIP computes of each image alone.
struct Seen {
  explicit Seen(const Image& image) : Seen(ToOpponents(image)) {}
  explicit Seen(const Opponents& planes)
      : colors(BlurAsSeen(planes)),
        edges(FeatureStrength(planes[0], 1)),
        points(FeatureStrength(planes[0], 2)) {}

  Opponents colors;
  Plane edges, points;
};

// (p0 x^2 + p1 x) / (q0 x^2 + q1 x + q2): K. Narkowicz. ACES Filmic Tone Mapping Curve. 2015. [2] takes
// it at 0.6 x. Where x is negative it isn't monotonic, but has no pole.
constexpr double kP0 = 0.6 * 0.6 * 2.51, kP1 = 0.6 * 0.03;
constexpr double kQ0 = 0.6 * 0.6 * 2.43, kQ1 = 0.6 * 0.59, kQ2 = 0.14;

double ToneCurve(double x) {
  // Beyond this, on both sides, it is above 1 and would overflow.
  constexpr double kBright = 1e6;
  x = std::clamp(x, -kBright, kBright);
  return std::clamp((kP0 * x * x + kP1 * x) / (kQ0 * x * x + kQ1 * x + kQ2), 0.0, 1.0);
}

Image ToneMapped(const Image& image, double exposure) {
  const double scale = std::exp2(exposure);
  Image mapped = image;
  for (float& value : mapped.rgb) value = static_cast<float>(ToneCurve(scale * value));
  return mapped;
}

// Half of the luminances are below it; as [2]'s authors' program has it: the mean of those of rank
// floor(n / 2) and the next (counted from 1), whether n is even or odd.
double MedianLuminance(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t upper = values.size() / 2, lower = upper == 0 ? 0 : upper - 1;
  return 0.5 * (values[lower] + values[upper]);
}

}  // namespace

std::vector<double> FlipMap(const Image& reference, const Image& test) {
  const Seen x(reference), y(test);
  const double largest = HyAb(HuntLab({0.0, 1.0, 0.0}), HuntLab({0.0, 0.0, 1.0}));
  std::vector<double> map(x.edges.values.size());
  ForEachRow(reference.height, [&](int row) {
    const std::size_t width = static_cast<std::size_t>(reference.width);
    for (std::size_t i = width * std::size_t(row); i < width * std::size_t(row + 1); ++i) {
      const double color =
          ColorError(HyAb(SeenColor(x.colors, i), SeenColor(y.colors, i)), largest);
      const double feature = FeatureError(x.edges.values[i] - y.edges.values[i],
                                          x.points.values[i] - y.points.values[i]);
      map[i] = std::pow(color, std::max(1.0 - feature, 0.0));
    }
  });
  return map;
}

FlipExposures ReferenceExposures(const Image& reference) {
  // As [2]'s authors' program has it: the spacing of single precision at 1.
  constexpr double kLeastMedian = std::numeric_limits<float>::epsilon();

  std::vector<double> luminances;
  for (std::size_t i = 0; i < reference.rgb.size(); i += 3) {
    const float* rgb = &reference.rgb[i];
    luminances.push_back(Luminance({rgb[0], rgb[1], rgb[2]}));
  }
  const double largest = *std::max_element(luminances.begin(), luminances.end());
  if (!(largest > 0.0)) return {};
  const double median = std::max(MedianLuminance(luminances), kLeastMedian);

  // The positive x with ToneCurve(x) = 0.85.
  constexpr double kShown = 0.85;
  constexpr double kA = kP0 - kShown * kQ0, kB = kP1 - kShown * kQ1, kC = -kShown * kQ2;
  const double x = (-kB + std::sqrt(kB * kB - 4.0 * kA * kC)) / (2.0 * kA);
  FlipExposures exposures;
  exposures.first = std::log2(x / largest);
  exposures.last = std::log2(x / median);
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.last - exposures.first)));
  return exposures;
}

std::vector<double> HdrFlipMap(const Image& reference, const Image& test) {
  const FlipExposures exposures = ReferenceExposures(reference);
  const double step = (exposures.last - exposures.first) / (exposures.count - 1);
  std::vector<double> largest(reference.rgb.size() / 3);
  for (int i = 0; i < exposures.count; ++i) {
    const double exposure = exposures.first + i * step;
    const std::vector<double> map =
        FlipMap(ToneMapped(reference, exposure), ToneMapped(test, exposure));
    for (std::size_t k = 0; k < map.size(); ++k) largest[k] = std::max(largest[k], map[k]);
  }
  return largest;
}

}  // namespace pbnbrdf
