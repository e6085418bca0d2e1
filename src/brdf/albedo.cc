#include "pbnbrdf/brdf/albedo.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/merl.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHorizon = 0.5 * kPi - 1e-9;  // nearly

// P_n(x) and its derivative, by the three-term recurrence.
struct Legendre {
  double value, slope;
};

Legendre EvaluateLegendre(int n, double x) {
  double before = 1.0, value = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return {value, n * (x * value - before) / (x * x - 1.0)};
}

// theta_i of a stratum, and its solid angle.
struct IncidentStratum {
  double theta_i, solid_angle;
};

// The k-th of the grid: theta_i = last_angle (1 - s^2), s from 1 to 0.
IncidentStratum StratumOf(const AlbedoGrid& grid, int k) {
  const double s = 1.0 - (k + 0.5) / grid.angles, theta_i = grid.last_angle * (1.0 - s * s);
  return {theta_i, 2.0 * kPi * std::sin(theta_i) * 2.0 * grid.last_angle * s / grid.angles};
}

double Largest(const Rgb& rgb) { return std::max({rgb[0], rgb[1], rgb[2]}); }

// Where the parabola through three neighbours has its vertex, if the middle one is the largest.
// Returns whether it has.
bool Vertex(const IncidentAlbedo* middle, int channel, double* theta_i) {
  const double x0 = middle[-1].theta_i - middle[0].theta_i;
  const double x1 = middle[1].theta_i - middle[0].theta_i;
  const double y0 = middle[-1].albedo[channel] - middle[0].albedo[channel];
  const double y1 = middle[1].albedo[channel] - middle[0].albedo[channel];
  if (!(y0 < 0.0) || !(y1 < 0.0)) return false;
  *theta_i = middle[0].theta_i + 0.5 * (y0 * x1 * x1 - y1 * x0 * x0) / (y0 * x1 - y1 * x0);
  return true;
}

double LargestDifference(const Rgb& a, const Rgb& b) {
  return Largest({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// As AlbedoGrid says.
class RefinedAlbedo {
 public:
  RefinedAlbedo(const Brdf& brdf, const AlbedoGrid& grid) : brdf_(brdf), grid_(grid) {
    int n_theta = grid.n_theta, n_phi = grid.n_phi;
    for (int level = 0; level < kLevels; ++level) {
      levels_.push_back(AlbedoQuadrature::OnMerlRows(n_theta, n_phi));
      n_theta = std::min(n_theta + (n_theta + 1) / 2, kMostTheta);
      n_phi += n_phi / 2;
    }
  }

  Rgb At(double theta_i, double phi_i) const {
    const Vec3 wi = FromSpherical(theta_i, phi_i);
    Rgb albedo = DirectionalAlbedo(brdf_, wi, coarse_);
    double error = kCoarseError * Largest(albedo);
    for (const AlbedoQuadrature& level : levels_) {
      const double largest = Largest(albedo);
      const double tolerance = std::max(grid_.tolerance, kExcessError * (largest - 1.0));
      if (error <= tolerance || largest + kMargin * error < grid_.refine_above) break;
      const Rgb finer = DirectionalAlbedo(brdf_, wi, level);
      error = LargestDifference(finer, albedo);
      albedo = finer;
    }
    return albedo;
  }

  // Whether an albedo may be above grid.refine_above, as far as the coarse quadrature tells.
  bool IsNear(double albedo) const {
    return albedo * (1.0 + kMargin * kCoarseError) > grid_.refine_above;
  }

 private:
  static constexpr int kLevels = 7;
  static constexpr int kMostTheta = 6;  // exact enough; what needs more are ridges over phi_h
  static constexpr double kCoarseError = 2e-3;  // relative
  static constexpr double kExcessError = 0.01;  // of what the albedo is above 1
  static constexpr double kMargin = 10.0;

  const Brdf& brdf_;
  const AlbedoGrid& grid_;
  AlbedoQuadrature coarse_ = AlbedoQuadrature(64, 32);
  std::vector<AlbedoQuadrature> levels_;
};

// What may lie between the directions of a row of the same phi_i, theta_i growing, and behind its
// end: the local maxima, and the last angle.
std::vector<IncidentAlbedo> Additions(const RefinedAlbedo& refined, double last_angle,
                                      std::span<const IncidentAlbedo> row) {
  const double phi_i = row[0].phi_i;
  std::vector<IncidentAlbedo> additions;
  const auto add = [&](double theta_i) {
    additions.push_back({theta_i, phi_i, 0.0, refined.At(theta_i, phi_i)});
  };
  for (std::size_t k = 1; k + 1 < row.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      double theta_i;
      if (refined.IsNear(row[k].albedo[c]) && Vertex(&row[k], c, &theta_i)) add(theta_i);
    }
  }
  add(std::min(last_angle, kHorizon));
  return additions;
}

}  // namespace

GaussLegendre::GaussLegendre(int n) : nodes(n), weights(n) {
  for (int k = 0; k < (n + 1) / 2; ++k) {
    // Newton's method from an estimate of the k-th root that is good to 1e-2 / n.
    double x = std::cos(kPi * (k + 0.75) / (n + 0.5));
    Legendre p = EvaluateLegendre(n, x);
    for (int iteration = 0; iteration < 10 && std::abs(p.value) > 1e-15; ++iteration) {
      x -= p.value / p.slope;
      p = EvaluateLegendre(n, x);
    }
    nodes[k] = 0.5 * (1.0 - x);
    nodes[n - 1 - k] = 0.5 * (1.0 + x);
    weights[k] = weights[n - 1 - k] = 1.0 / ((1.0 - x * x) * p.slope * p.slope);
  }
}

AlbedoQuadrature::AlbedoQuadrature(int n_theta, int n_phi) : x_(n_theta) {
  const auto add_half = [&](double first, int n) {
    const GaussLegendre rule(n);
    for (int k = 0; k < n; ++k) {
      const double x = rule.nodes[k];
      phi_.push_back(first + kPi * x * x * (3.0 - 2.0 * x));
      phi_weights_.push_back(kPi * rule.weights[k] * 6.0 * x * (1.0 - x));
    }
  };
  add_half(-0.5 * kPi, n_phi / 2);
  add_half(0.5 * kPi, n_phi - n_phi / 2);
}

AlbedoQuadrature AlbedoQuadrature::OnMerlRows(int n_theta, int n_phi) {
  AlbedoQuadrature quadrature(n_theta, n_phi);
  quadrature.on_merl_rows_ = true;
  return quadrature;
}

std::vector<AlbedoQuadrature::Cell> AlbedoQuadrature::Cells(double theta_max) const {
  if (!on_merl_rows_) return {{0.0, theta_max, 3}};
  std::vector<Cell> cells;
  for (int row = 0; row < MerlBrdf::kThetaH; ++row) {
    const double first = MerlBrdf::RowAngle(row), last = MerlBrdf::RowAngle(row + 1);
    if (first < theta_max) cells.push_back({first, std::min(last, theta_max), 1});
  }
  return cells;
}

std::vector<AlbedoNode> AlbedoQuadrature::Nodes(const Vec3& wi) const {
  const double sin_i = std::hypot(wi.x, wi.y), phi_i = std::atan2(wi.y, wi.x);
  std::vector<AlbedoNode> nodes;
  for (std::size_t p = 0; p < phi_.size(); ++p) {
    // cos_o = 2 (wi.h) h.z - wi.z = |.| cos(2 theta_h - psi) reaches 0 at theta_max.
    const double psi = std::atan2(sin_i * std::cos(phi_[p]), wi.z);
    const Vec3 tilt = FromSpherical(0.5 * kPi, phi_i + phi_[p]);
    for (const auto& [first, last, power] : Cells(0.25 * kPi + 0.5 * psi)) {
      for (std::size_t t = 0; t < x_.nodes.size(); ++t) {
        const double x = x_.nodes[t], below = power == 1 ? 1.0 : x * x;
        const double theta_h = first + (last - first) * below * x;
        const double sin_h = std::sin(theta_h);
        const Vec3 h = {sin_h * tilt.x, sin_h * tilt.y, std::cos(theta_h)};
        const double cos_d = Dot(wi, h);
        const Vec3 wo = 2.0 * cos_d * h - wi;
        if (!(wo.z > 0.0) || !(cos_d > 0.0)) continue;
        const double solid_angle_h = sin_h * (last - first) * power * below *
                                     x_.weights[t] * phi_weights_[p];
        nodes.push_back({{wi, wo}, wo.z * 4.0 * cos_d * solid_angle_h});
      }
    }
  }
  return nodes;
}

Rgb DirectionalAlbedo(const Brdf& brdf, const Vec3& wi, const AlbedoQuadrature& quadrature) {
  const std::vector<AlbedoNode> nodes = quadrature.Nodes(wi);
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

Rgb DirectionalAlbedo(const Brdf& brdf, const Vec3& wi, int n_theta, int n_phi) {
  return DirectionalAlbedo(brdf, wi, AlbedoQuadrature(n_theta, n_phi));
}

std::vector<IncidentAlbedo> AlbedoProfile(const Brdf& brdf, const AlbedoGrid& grid) {
  const RefinedAlbedo refined(brdf, grid);
  const int azimuths = brdf.IsIsotropic() ? 1 : grid.azimuths;
  std::vector<IncidentAlbedo> profile(static_cast<std::size_t>(azimuths) * grid.angles);
  tbb::parallel_for(std::size_t{0}, profile.size(), [&](std::size_t n) {
    const int row = static_cast<int>(n) / grid.angles;
    const auto [theta_i, solid_angle] = StratumOf(grid, static_cast<int>(n) % grid.angles);
    const double phi_i = 2.0 * kPi * row / azimuths;
    profile[n] = {theta_i, phi_i, solid_angle / azimuths, refined.At(theta_i, phi_i)};
  });
  std::vector<std::vector<IncidentAlbedo>> additions(azimuths);
  tbb::parallel_for(0, azimuths, [&](int row) {
    const std::size_t first = static_cast<std::size_t>(row) * grid.angles;
    additions[row] = Additions(refined, grid.last_angle, std::span(profile).subspan(first, grid.angles));
  });
  for (const auto& row : additions) profile.insert(profile.end(), row.begin(), row.end());
  return profile;
}

}  // namespace pbnbrdf
