#include "export/primaries.h"

#include <cmath>

#include "sources/cie.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kNumWavelengths = 16;
constexpr double kGreenFrom = 490.0, kRedFrom = 590.0, kSoft = 12.0;  // edges of the bands, nm

// x with x * columns = rgb, by Cramer's rule.
Vec3 Solve(const Vec3 (&columns)[3], const Vec3& rgb) {
  const Vec3 across = Cross(columns[1], columns[2]);
  const double determinant = Dot(columns[0], across);
  return {Dot(rgb, across) / determinant, Dot(columns[0], Cross(rgb, columns[2])) / determinant,
          Dot(columns[0], Cross(columns[1], rgb)) / determinant};
}

}  // namespace

std::vector<float> PrimaryWavelengths() {
  std::vector<float> wavelengths;
  for (std::size_t k = 0; k < kNumWavelengths; ++k) {
    wavelengths.push_back(
        static_cast<float>(kFirstPrimaryWavelength + kPrimaryWavelengthStep * double(k)));
  }
  return wavelengths;
}

std::vector<Vec3> SpectraOfPrimaries() {
  const std::vector<float> wavelengths = PrimaryWavelengths();
  const std::vector<Rgb> seen = SpectrumToRgb(wavelengths);
  std::vector<Vec3> bands;  // red, green, blue
  Vec3 colors[3] = {};
  for (std::size_t k = 0; k < wavelengths.size(); ++k) {
    const auto above = [&](double edge) {
      return 1.0 / (1.0 + std::exp((edge - wavelengths[k]) / kSoft));
    };
    const double red = above(kRedFrom), not_blue = above(kGreenFrom);
    bands.push_back({red, not_blue - red, 1.0 - not_blue});
    const Vec3 rgb = {seen[k][0], seen[k][1], seen[k][2]};
    colors[0] = colors[0] + bands[k].x * rgb;
    colors[1] = colors[1] + bands[k].y * rgb;
    colors[2] = colors[2] + bands[k].z * rgb;
  }
  const Vec3 r = Solve(colors, {1, 0, 0}), g = Solve(colors, {0, 1, 0}),
             b = Solve(colors, {0, 0, 1});
  std::vector<Vec3> spectra;
  for (const Vec3& band : bands) spectra.push_back({Dot(band, r), Dot(band, g), Dot(band, b)});
  return spectra;
}

}  // namespace pbnbrdf
