#include "pbnbrdf/brdf/albedo.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "base/parallel.h"
#include "base/pi.h"
#include "pbnbrdf/brdf/merl_rows.h"

namespace pbnbrdf {
namespace {

constexpr double kHorizon = 0.5 * kPi - 1e-9;  // nearly
constexpr int kMaximaSteps = 3;                // of successive parabolic interpolation

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

// Each rule is made once.
const GaussLegendre& RuleOf(int n) {
  static std::mutex mutex;
  static std::map<int, GaussLegendre> rules;
  const std::lock_guard lock(mutex);
  return rules.try_emplace(n, n).first->second;
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

// The vertex of a parabola through three neighbours.
struct Vertex {
  double step;  // of theta_i, from the middle one
  double gain;  // over its albedo
};

// Of those whose middle one is the largest, unless it is the vertex itself.
std::optional<Vertex> FindVertex(const IncidentAlbedo* middle, int channel) {
  constexpr double kElsewhere = 1e-3;
  const double x0 = middle[-1].theta_i - middle[0].theta_i;
  const double x1 = middle[1].theta_i - middle[0].theta_i;
  const double y0 = middle[-1].albedo[channel] - middle[0].albedo[channel];
  const double y1 = middle[1].albedo[channel] - middle[0].albedo[channel];
  if (!(y0 < 0.0) || !(y1 < 0.0)) return std::nullopt;
  // y = b x + a x^2
  const double determinant = x0 * x1 * (x1 - x0);
  const double a = (y1 * x0 - y0 * x1) / determinant;
  const double b = (y0 * x1 * x1 - y1 * x0 * x0) / determinant;
  const Vertex vertex = {-0.5 * b / a, -0.25 * b * b / a};
  if (std::abs(vertex.step) <= kElsewhere * (x1 - x0)) return std::nullopt;
  return vertex;
}

Rgb Difference(const Rgb& a, const Rgb& b) {
  return {std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])};
}

// An albedo as far as it is known.
struct Estimate {
  Rgb albedo;
  Rgb error;              // about
  std::size_t level = 0;  // of refinement
  bool is_exact = true;   // else in single precision
};

// Albedos by quadratures that are refined as AlbedoGrid says: in single precision, where the Brdf
// has it, for as long as this is good enough.
class RefinedAlbedo {
 public:
  RefinedAlbedo(const Brdf& brdf, const AlbedoGrid& grid)
      : brdf_(brdf), single_(brdf.SinglePrecision()), grid_(grid) {
    int n_theta = grid.n_theta, n_phi = grid.n_phi;
    for (int level = 0; level < grid.refinements; ++level) {
      levels_.push_back(AlbedoQuadrature::OnMerlRows(n_theta, n_phi));
      n_theta += (n_theta + 1) / 2;
      n_phi += n_phi / 2;
    }
  }

  // By the first quadrature; in single precision where a small one has it agree with double there.
  Estimate At(const Vec3& wi) const {
    Estimate estimate = {.albedo = {}, .error = {}};
    if (single_) {
      const Rgb single = DirectionalAlbedo(*single_, wi, check_);
      const Rgb exact = DirectionalAlbedo(brdf_, wi, check_);
      estimate.is_exact = !(Largest(Difference(single, exact)) <= kRounding);
    }
    const Brdf& brdf = estimate.is_exact ? brdf_ : *single_;
    estimate.albedo = DirectionalAlbedo(brdf, wi, coarse_);
    // Another grid meets ripples at other places.
    estimate.error = Difference(DirectionalAlbedo(brdf, wi, other_), estimate.albedo);
    for (int c = 0; c < 3; ++c) {
      estimate.error[c] = std::max(estimate.error[c], kCoarseError * estimate.albedo[c]);
    }
    return estimate;
  }

  // One step, to the next quadrature or from single to double precision; false if the estimate is
  // good already.
  bool Refine(const Vec3& wi, const Rgb& bound, Estimate* estimate) const {
    if (!IsWanted(*estimate, bound)) return false;
    const bool is_last = estimate->level == levels_.size();
    const bool is_rounding = Largest(estimate->error) <= kRounding;
    if (!estimate->is_exact && estimate->level > 0 && (is_rounding || is_last)) {
      estimate->albedo = DirectionalAlbedo(brdf_, wi, levels_[estimate->level - 1]);
      estimate->is_exact = true;
      return true;
    }
    if (is_last) return false;
    const Brdf& brdf = estimate->is_exact ? brdf_ : *single_;
    const Rgb finer = DirectionalAlbedo(brdf, wi, levels_[estimate->level++]);
    estimate->error = Difference(finer, estimate->albedo);
    estimate->albedo = finer;
    return true;
  }

  // Raises the bound to what an albedo is at least.
  static void Raise(const Estimate& estimate, Rgb* bound) {
    for (int c = 0; c < 3; ++c) {
      (*bound)[c] = std::max((*bound)[c], estimate.albedo[c] - kMargin * Error(estimate, c));
    }
  }

 private:
  static constexpr double kCoarseError = 0.01;  // relative, seen at networks with ripples
  static constexpr double kRounding = 1e-5;     // most that single precision may be off
  static constexpr double kMargin = 4.0;

  static double Error(const Estimate& estimate, int channel) {
    const double error = estimate.error[channel];
    return estimate.is_exact ? error : std::max(error, kRounding);
  }

  // Whether a channel that may exceed the bound isn't known well enough.
  bool IsWanted(const Estimate& estimate, const Rgb& bound) const {
    for (int c = 0; c < 3; ++c) {
      const double albedo = estimate.albedo[c], error = Error(estimate, c);
      const double excess = grid_.excess_tolerance * (albedo - 1.0);
      const bool is_accurate = error <= std::max(grid_.tolerance, excess);
      const bool may_exceed = !(albedo + kMargin * error < bound[c]);
      if (may_exceed && !is_accurate) return true;
    }
    return false;
  }

  const Brdf& brdf_;
  const std::unique_ptr<const Brdf> single_;  // or null
  const AlbedoGrid& grid_;
  AlbedoQuadrature coarse_ = AlbedoQuadrature(64, 32), other_ = AlbedoQuadrature(45, 32),
                   check_ = AlbedoQuadrature(24, 16);
  std::vector<AlbedoQuadrature> levels_;
};

// The theta_i, between those of a row of the same phi_i, of the local maxima that may exceed the
// bound.
std::vector<double> Maxima(std::span<const IncidentAlbedo> row, const Rgb& bound) {
  constexpr double kMostGains = 4.0, kMargin = 1e-4;  // relative
  // Rounding of values mustn't move the angles: a table's albedo may jump between two of them.
  constexpr double kAngle = 1e-9;
  std::vector<double> angles;
  for (std::size_t k = 1; k + 1 < row.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const std::optional<Vertex> vertex = FindVertex(&row[k], c);
      if (!vertex) continue;
      const double most = row[k].albedo[c] + kMostGains * vertex->gain;
      const double theta_i = kAngle * std::round((row[k].theta_i + vertex->step) / kAngle);
      const bool is_known = std::find(angles.begin(), angles.end(), theta_i) != angles.end();
      // Known are those of grey materials, by their first channel.
      if (most >= (1.0 - kMargin) * bound[c] && !is_known) angles.push_back(theta_i);
    }
  }
  return angles;
}

// The grid's own directions and, at the end of each row, the last angle.
std::vector<IncidentAlbedo> GridDirections(const AlbedoGrid& grid, int azimuths) {
  std::vector<IncidentAlbedo> directions;
  for (int row = 0; row < azimuths; ++row) {
    const double phi_i = 2.0 * kPi * row / azimuths;
    for (int k = 0; k < grid.angles; ++k) {
      const auto [theta_i, solid_angle] = StratumOf(grid, k);
      directions.push_back({theta_i, phi_i, solid_angle / azimuths, {}});
    }
    directions.push_back({std::min(grid.last_angle, kHorizon), phi_i, 0.0, {}});
  }
  return directions;
}

// The directions of local maxima, albedos not yet known. profile: sorted by phi_i, then theta_i.
std::vector<IncidentAlbedo> MaximaBetween(const std::vector<IncidentAlbedo>& profile,
                                          const AlbedoGrid& grid) {
  Rgb bound = LargestAlbedos(profile);
  for (double& channel : bound) channel = std::max(channel, grid.refine_above);
  std::vector<IncidentAlbedo> maxima;
  for (auto row = profile.begin(); row != profile.end();) {
    const double phi_i = row->phi_i;
    const auto end =
        std::find_if(row, profile.end(), [phi_i](const auto& at) { return at.phi_i != phi_i; });
    for (double theta_i : Maxima({row, end}, bound)) {
      maxima.push_back({theta_i, phi_i, 0.0, {}});
    }
    row = end;
  }
  return maxima;
}

// The albedos at all directions of a profile; those that may be the largest ones with all care.
void Fill(const RefinedAlbedo& refined, const AlbedoGrid& grid, std::span<IncidentAlbedo> profile) {
  std::vector<Estimate> estimates(profile.size());
  const auto wi = [&](std::size_t n) {
    return FromSpherical(profile[n].theta_i, profile[n].phi_i);
  };
  ParallelFor(profile.size(), [&](std::size_t n) { estimates[n] = refined.At(wi(n)); });
  // Below these, albedos are of no interest.
  Rgb bound = {grid.refine_above, grid.refine_above, grid.refine_above};
  for (std::atomic<bool> goes_on = true; goes_on;) {
    goes_on = false;
    for (const Estimate& estimate : estimates) RefinedAlbedo::Raise(estimate, &bound);
    ParallelFor(profile.size(), [&](std::size_t n) {
      if (refined.Refine(wi(n), bound, &estimates[n])) goes_on = true;
    });
  }
  for (std::size_t n = 0; n < profile.size(); ++n) profile[n].albedo = estimates[n].albedo;
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

AlbedoQuadrature::AlbedoQuadrature(int n_theta, int n_phi)
    : x_(&RuleOf(n_theta)), x_of_first_rows_(&RuleOf(2 * n_theta)) {
  const auto add_half = [&](double first, int n) {
    const GaussLegendre& rule = RuleOf(n);
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
  for (int row = 0; row < kMerlRows; ++row) {
    quadrature.row_begin_.push_back(quadrature.rows_.size());
    quadrature.AddCell(MerlRowAngle(row), MerlRowAngle(row + 1), /*power=*/1,
                       quadrature.RuleOfRow(row), &quadrature.rows_);
  }
  quadrature.row_begin_.push_back(quadrature.rows_.size());
  return quadrature;
}

// At grazing incidence the integrand changes within a few of the first rows' widths.
const GaussLegendre& AlbedoQuadrature::RuleOfRow(int row) const {
  constexpr int kFirstRows = 12;
  return row < kFirstRows ? *x_of_first_rows_ : *x_;
}

// The rule on theta_h = first + (last - first) x^power, power 1 or 3.
void AlbedoQuadrature::AddCell(double first, double last, int power, const GaussLegendre& rule,
                               std::vector<Tilt>* tilts) {
  for (std::size_t t = 0; t < rule.nodes.size(); ++t) {
    const double x = rule.nodes[t], below = power == 1 ? 1.0 : x * x;
    const double theta_h = first + (last - first) * below * x;
    tilts->push_back(
        {std::sin(theta_h), std::cos(theta_h), (last - first) * power * below * rule.weights[t]});
  }
}

void AlbedoQuadrature::AddPart(const Vec3& wi, int k, std::vector<AlbedoNode>* nodes) const {
  const double sin_i = std::hypot(wi.x, wi.y), phi_i = std::atan2(wi.y, wi.x);
  const auto p = static_cast<std::size_t>(k);
  // cos_o = 2 (wi.h) h.z - wi.z = |.| cos(2 theta_h - psi) reaches 0 at theta_max.
  const double psi = std::atan2(sin_i * std::cos(phi_[p]), wi.z);
  const double theta_max = 0.25 * kPi + 0.5 * psi;
  const Vec3 tilt = FromSpherical(0.5 * kPi, phi_i + phi_[p]);
  const auto add = [&](std::span<const Tilt> tilts) {
    for (const auto& [sin_h, cos_h, weight] : tilts) {
      const Vec3 h = {sin_h * tilt.x, sin_h * tilt.y, cos_h};
      const double cos_d = Dot(wi, h);
      const Vec3 wo = 2.0 * cos_d * h - wi;
      if (!(wo.z > 0.0) || !(cos_d > 0.0)) continue;
      nodes->push_back({{wi, wo}, wo.z * 4.0 * cos_d * sin_h * weight * phi_weights_[p]});
    }
  };
  std::vector<Tilt> rest;
  if (!rows_.empty()) {
    int row = 0;
    while (row < kMerlRows && MerlRowAngle(row + 1) <= theta_max) ++row;
    add(std::span(rows_).first(row_begin_[static_cast<std::size_t>(row)]));
    if (row == kMerlRows || !(MerlRowAngle(row) < theta_max)) return;
    AddCell(MerlRowAngle(row), theta_max, /*power=*/1, RuleOfRow(row), &rest);
  } else {
    AddCell(0.0, theta_max, /*power=*/3, *x_, &rest);
  }
  add(rest);
}

std::vector<AlbedoNode> AlbedoQuadrature::Nodes(const Vec3& wi) const {
  std::vector<AlbedoNode> nodes;
  for (int k = 0; k < NumParts(); ++k) AddPart(wi, k, &nodes);
  return nodes;
}

// In batches that stay in the cache.
Rgb DirectionalAlbedo(const Brdf& brdf, const Vec3& wi, const AlbedoQuadrature& quadrature) {
  constexpr std::size_t kBatch = 2048;
  std::vector<AlbedoNode> nodes;
  std::vector<DirectionPair> pairs;
  std::vector<Rgb> values;
  Rgb albedo = {};
  for (int k = 0; k < quadrature.NumParts(); ++k) {
    quadrature.AddPart(wi, k, &nodes);
    if (nodes.size() < kBatch && k + 1 < quadrature.NumParts()) continue;
    pairs.clear();
    for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
    values.resize(nodes.size());
    brdf.Evaluate(pairs, values);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (int c = 0; c < 3; ++c) albedo[c] += nodes[n].weight * values[n][c];
    }
    nodes.clear();
  }
  return albedo;
}

Rgb DirectionalAlbedo(const Brdf& brdf, const Vec3& wi, int n_theta, int n_phi) {
  return DirectionalAlbedo(brdf, wi, AlbedoQuadrature(n_theta, n_phi));
}

std::vector<IncidentAlbedo> AlbedoProfile(const Brdf& brdf, const AlbedoGrid& grid) {
  const RefinedAlbedo refined(brdf, grid);
  std::vector<IncidentAlbedo> profile =
      GridDirections(grid, brdf.IsIsotropic() ? 1 : grid.azimuths);
  Fill(refined, grid, profile);
  for (int k = 0; k < kMaximaSteps; ++k) {
    std::vector<IncidentAlbedo> maxima = MaximaBetween(profile, grid);
    Fill(refined, grid, maxima);
    profile.insert(profile.end(), maxima.begin(), maxima.end());
    std::sort(profile.begin(), profile.end(), [](const auto& a, const auto& b) {
      return std::pair(a.phi_i, a.theta_i) < std::pair(b.phi_i, b.theta_i);
    });
  }
  return profile;
}

Rgb LargestAlbedos(const std::vector<IncidentAlbedo>& profile) {
  Rgb largest = {};
  for (const IncidentAlbedo& at : profile) {
    for (int c = 0; c < 3; ++c) largest[c] = std::max(largest[c], at.albedo[c]);
  }
  return largest;
}

const IncidentAlbedo& LargestIn(const std::vector<IncidentAlbedo>& profile, int channel) {
  return *std::max_element(profile.begin(), profile.end(),
                           [channel](const IncidentAlbedo& a, const IncidentAlbedo& b) {
                             return a.albedo[channel] < b.albedo[channel];
                           });
}

}  // namespace pbnbrdf
