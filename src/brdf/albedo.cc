#include "pbnbrdf/brdf/albedo.h"

#include <cmath>
#include <numbers>

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

std::vector<AlbedoNode> AlbedoQuadrature(double theta_i, int n_theta, int n_phi) {
  const Vec3 wi = FromSpherical(theta_i, 0.0);
  std::vector<AlbedoNode> nodes;
  nodes.reserve(static_cast<std::size_t>(n_theta) * n_phi);
  for (int p = 0; p < n_phi; ++p) {
    const double phi = 2.0 * kPi * (p + 0.5) / n_phi;
    // cos_o = 2 (wi.h) h.z - wi.z = |.| cos(2 theta_h - psi) reaches 0 at theta_max.
    const double psi = std::atan2(wi.x * std::cos(phi), wi.z);
    const double theta_max = 0.25 * kPi + 0.5 * psi;
    for (int t = 0; t < n_theta; ++t) {
      const double u = (t + 0.5) / n_theta;
      const double theta_h = theta_max * u * u * u;
      const Vec3 h = FromSpherical(theta_h, phi);
      const double cos_d = Dot(wi, h);
      const Vec3 wo = 2.0 * cos_d * h - wi;
      if (!(wo.z > 0.0) || !(cos_d > 0.0)) continue;
      const double solid_angle_h = std::sin(theta_h) * theta_max * 3.0 * u * u / n_theta *  //
                                   (2.0 * kPi / n_phi);
      nodes.push_back({{wi, wo}, wo.z * 4.0 * cos_d * solid_angle_h});
    }
  }
  return nodes;
}

Rgb DirectionalAlbedo(const Brdf& brdf, double theta_i, int n_theta, int n_phi) {
  const std::vector<AlbedoNode> nodes = AlbedoQuadrature(theta_i, n_theta, n_phi);
  std::vector<DirectionPair> pairs;
  pairs.reserve(nodes.size());
  for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
  std::vector<Rgb> values(nodes.size());
  brdf.Evaluate(pairs, values);
  Rgb albedo = {};
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (int c = 0; c < 3; ++c) albedo[c] += nodes[n].weight * values[n][c];
  }
  return albedo;
}

}  // namespace pbnbrdf
