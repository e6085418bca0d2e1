#include "sources/cie.h"

#include <cmath>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kFirst = 380.0, kLast = 780.0, kStep = 10.0;  // of the table, nm
constexpr double kD65[] = {49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865,
                           117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
                           104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880,
                           88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
                           80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040,
                           69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
constexpr int kEntries = static_cast<int>(std::size(kD65));
static_assert(kFirst + kStep * (kEntries - 1) == kLast);

// XYZ to linear sRGB, IEC 61966-2-1.
constexpr double kToRgb[3][3] = {
    {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};

constexpr double kMustBegin = 430.0, kMustEnd = 660.0;

double Lobe(double x, double mean, double below, double above) {
  const double t = (x - mean) / (x < mean ? below : above);
  return std::exp(-0.5 * t * t);
}

}  // namespace

std::array<double, 3> ColorMatching(double l) {
  return {1.056 * Lobe(l, 599.8, 37.9, 31.0) + 0.362 * Lobe(l, 442.0, 16.0, 26.7) -
              0.065 * Lobe(l, 501.1, 20.4, 26.2),
          0.821 * Lobe(l, 568.8, 46.9, 40.5) + 0.286 * Lobe(l, 530.9, 16.3, 31.1),
          1.217 * Lobe(l, 437.0, 11.8, 36.0) + 0.681 * Lobe(l, 459.0, 26.0, 13.8)};
}

double IlluminantD65(double wavelength) {
  if (!(wavelength >= kFirst && wavelength <= kLast)) return 0.0;
  const double x = (wavelength - kFirst) / kStep;
  const int below = std::min(static_cast<int>(x), kEntries - 2);
  return kD65[below] + (x - below) * (kD65[below + 1] - kD65[below]);
}

std::vector<Rgb> SpectrumToRgb(std::span<const float> wavelengths) {
  if (wavelengths.size() == 1) return {{1.0, 1.0, 1.0}};
  if (!(wavelengths.front() <= kMustBegin && wavelengths.back() >= kMustEnd)) {
    Fail("wavelengths of ", wavelengths.front(), " to ", wavelengths.back(), " nm; a colour needs ",
         kMustBegin, " to ", kMustEnd);
  }
  if (!(wavelengths.back() <= kLongestWavelength)) {
    Fail("a wavelength of ", wavelengths.back(), " nm; at most ", kLongestWavelength);
  }
  std::vector<Rgb> weights(wavelengths.size(), Rgb{});
  Rgb sums = {};
  // The midpoint rule with steps of about 1 nm within each interval.
  for (std::size_t k = 0; k + 1 < wavelengths.size(); ++k) {
    const double begin = wavelengths[k], width = double(wavelengths[k + 1]) - begin;
    const int steps = static_cast<int>(std::ceil(width));
    for (int s = 0; s < steps; ++s) {
      const double t = (s + 0.5) / steps, l = begin + t * width;
      const std::array<double, 3> xyz = ColorMatching(l);
      for (int c = 0; c < 3; ++c) {
        const double w = IlluminantD65(l) * width / steps *
                         (kToRgb[c][0] * xyz[0] + kToRgb[c][1] * xyz[1] + kToRgb[c][2] * xyz[2]);
        weights[k][c] += (1.0 - t) * w;
        weights[k + 1][c] += t * w;
        sums[c] += w;
      }
    }
  }
  for (Rgb& weight : weights) {
    for (int c = 0; c < 3; ++c) weight[c] /= sums[c];
  }
  return weights;
}

std::vector<Rgb> SpectrumToRgb(const std::string& path, std::span<const float> wavelengths) {
  try {
    return SpectrumToRgb(wavelengths);
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
}

std::vector<Rgb> XyzToRgb() {
  std::vector<Rgb> weights(3);
  for (int k = 0; k < 3; ++k) weights[k] = {kToRgb[0][k], kToRgb[1][k], kToRgb[2][k]};
  return weights;
}

Rgb WeightedSum(std::span<const Rgb> weights, std::span<const double> values) {
  Rgb sum = {};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    for (int c = 0; c < 3; ++c) sum[c] += weights[k][c] * values[k];
  }
  return sum;
}

}  // namespace pbnbrdf
