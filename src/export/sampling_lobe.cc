#include "pbnbrdf/export/sampling_lobe.h"

#include <array>
#include <limits>
#include <numbers>
#include <vector>

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kThetaSteps = 128, kPhiSteps = 32;  // of the half vector
constexpr std::array<double, 4> kAngles = {0.0, kPi / 6.0, kPi / 3.0, 4.0 * kPi / 9.0};

// One point of the quadrature over outgoing directions.
struct Point {
  double second_moment;  // (f cos)^2 times its solid angle, luminance of Rec. 709
  double cos_v, cos_o;
  double tan2_h, cos4_h;
};

double GgxPdf(const Point& at, double alpha) {
  const double a2 = alpha * alpha, cos2_v = at.cos_v * at.cos_v;
  const double spread = a2 + at.tan2_h;
  const double d = a2 / (kPi * at.cos4_h * spread * spread);
  const double g1 = 2.0 / (1.0 + std::sqrt(1.0 + a2 * (1.0 - cos2_v) / cos2_v));
  return g1 * d / (4.0 * at.cos_v);
}

// Points for one direction v, stratified in the half vector as the map of the albedo is: a narrow
// lobe falls between those of a uniform grid. Scaled so that the squared mean of f cos is 1; empty
// if it is 0.
std::vector<Point> Points(const Brdf& brdf, const Vec3& v) {
  std::vector<Point> points;
  std::vector<DirectionPair> pairs;
  std::vector<double> solid_angles;
  for (int t = 0; t < kThetaSteps; ++t) {
    const double u = (t + 0.5) / kThetaSteps, theta_h = 0.5 * kPi * u * u;
    const double half_angle = kPi * u / kThetaSteps * std::sin(theta_h) * 2.0 * kPi / kPhiSteps;
    const double cos2 = std::cos(theta_h) * std::cos(theta_h), sin2 = 1.0 - cos2;
    for (int p = 0; p < kPhiSteps; ++p) {
      const Vec3 h = FromSpherical(theta_h, 2.0 * kPi * (p + 0.5) / kPhiSteps);
      const double along = Dot(v, h);
      const Vec3 wo = (2.0 * along) * h - v;
      if (!(along > 0.0 && wo.z > 0.0)) continue;
      pairs.push_back({wo, v});
      points.push_back({0.0, v.z, wo.z, sin2 / cos2, cos2 * cos2});
      solid_angles.push_back(4.0 * along * half_angle);
    }
  }
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  double mean = 0.0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const auto& [r, g, b] = values[n];
    const double f_cos = (0.2126 * r + 0.7152 * g + 0.0722 * b) * points[n].cos_o;
    points[n].second_moment = f_cos * f_cos * solid_angles[n];
    mean += f_cos * solid_angles[n];
  }
  if (!(mean > 0.0)) return {};
  for (Point& point : points) point.second_moment /= mean * mean;
  return points;
}

}  // namespace

SamplingLobe FitSamplingLobe(const Brdf& brdf) {
  constexpr int kAlphas = 32, kAzimuths = 4, kWeights = 9;
  constexpr double kSmallestAlpha = 0.002;
  std::vector<Point> points;
  for (double theta : kAngles) {
    for (int p = 0; p < (brdf.IsIsotropic() ? 1 : kAzimuths); ++p) {
      const std::vector<Point> more = Points(brdf, FromSpherical(theta, p * kPi / kAzimuths));
      points.insert(points.end(), more.begin(), more.end());
    }
  }
  SamplingLobe best;
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < kAlphas; ++a) {
    const double alpha = std::pow(kSmallestAlpha, 1.0 - a / (kAlphas - 1.0));
    std::array<double, kWeights> moments = {};
    for (const Point& point : points) {
      const double ggx = GgxPdf(point, alpha), cosine = point.cos_o / kPi;
      for (int w = 0; w < kWeights; ++w) {
        const double weight = (w + 1) / 10.0;
        moments[w] += point.second_moment / (weight * ggx + (1.0 - weight) * cosine);
      }
    }
    for (int w = 0; w < kWeights; ++w) {
      if (moments[w] >= least) continue;
      least = moments[w];
      best = {alpha, (w + 1) / 10.0};
    }
  }
  return best;
}

}  // namespace pbnbrdf
