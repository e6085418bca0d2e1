// The proposal of least variance for a Brdf.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "brdf/ggx_reflections.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/importance_sampler.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostLobeWeight = 0.95;
constexpr double kThetas[] = {5.0, 20.0, 35.0, 50.0, 65.0, 78.0};  // degrees
constexpr int kAzimuths = 6;  // over half a turn: f is the same for wi and wo turned by 180 degrees
constexpr int kWidths = 33;   // of the search, evenly spaced in the logarithm

// A point of the quadrature over wo, given wi.
struct Point {
  DirectionPair pair;
  double second_moment;  // of (f cos_o / albedo)^2 dwo, a share in the mean over wi
  double cosine_pdf;
};

// Where a unimodal function of [low, high] is least, within `tolerance`: golden section.
double Minimize(const std::function<double(double)>& function, double low, double high,
                double tolerance) {
  const double ratio = std::numbers::phi - 1.0;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = function(a), at_b = function(b);
  while (high - low > tolerance) {
    if (at_a <= at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - ratio * (high - low);
      at_a = function(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + ratio * (high - low);
      at_b = function(b);
    }
  }
  return 0.5 * (low + high);
}

// Adds the points of one incident direction, unless the Brdf reflects nothing from it.
void AddPoints(const Brdf& brdf, const Vec3& wi, const AlbedoQuadrature& quadrature,
               std::vector<Point>* points) {
  const std::vector<AlbedoNode> nodes = quadrature.Nodes(wi);
  std::vector<DirectionPair> pairs;
  for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  std::vector<double> sums(pairs.size());
  double albedo = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    sums[n] = values[n][0] + values[n][1] + values[n][2];
    albedo += nodes[n].weight * sums[n];
  }
  if (!std::isfinite(albedo)) Fail("a value isn't finite: no proposal can be fitted");
  if (!(albedo > 0.0)) return;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double cos_o = pairs[n].wo.z, share = sums[n] / albedo;
    points->push_back({pairs[n], nodes[n].weight * cos_o * share * share, cos_o / kPi});
  }
}

std::vector<Point> PointsOf(const Brdf& brdf) {
  const AlbedoQuadrature quadrature(48, brdf.IsIsotropic() ? 24 : 48);
  const int azimuths = brdf.IsIsotropic() ? 1 : kAzimuths;
  std::vector<Point> points;
  for (double theta : kThetas) {
    for (int k = 0; k < azimuths; ++k) {
      AddPoints(brdf, FromSpherical(theta * kPi / 180.0, k * kPi / azimuths), quadrature, &points);
    }
  }
  return points;
}

// The sum over the points of the second moment of f cos_o / p, for one width of lobe.
class Moment {
 public:
  Moment(const std::vector<Point>& points, LobeWidths alpha) : points_(points) {
    for (const Point& point : points) lobe_pdf_.push_back(GgxReflectionDensity(point.pair, alpha));
  }

  double At(double lobe_weight) const {
    double sum = 0.0;
    for (std::size_t n = 0; n < points_.size(); ++n) {
      const double cosine = points_[n].cosine_pdf;
      sum += points_[n].second_moment / (cosine + lobe_weight * (lobe_pdf_[n] - cosine));
    }
    return sum;
  }

  // It is convex in the weight; the search ends beside an end of its range.
  double BestWeight() const {
    const double inside = Minimize([&](double w) { return At(w); }, 0.0, kMostLobeWeight, 1e-3);
    const double end = inside < 0.5 * kMostLobeWeight ? 0.0 : kMostLobeWeight;
    return At(inside) < At(end) ? inside : end;
  }

 private:
  const std::vector<Point>& points_;
  std::vector<double> lobe_pdf_;
};

double LeastMoment(const std::vector<Point>& points, LobeWidths alpha) {
  const Moment moment(points, alpha);
  return moment.At(moment.BestWeight());
}

// The logarithm of the best width of a lobe that is the same all around.
double BestLogWidth(const std::vector<Point>& points) {
  const double first = std::log(LobeProposal::kLeastWidth);
  const double step = (std::log(LobeProposal::kMostWidth) - first) / (kWidths - 1);
  std::vector<double> moments;
  for (int k = 0; k < kWidths; ++k) {
    moments.push_back(LeastMoment(points, std::exp(first + k * step)));
  }
  const auto best = std::min_element(moments.begin(), moments.end()) - moments.begin();
  const double low = first + step * static_cast<double>(std::max<std::ptrdiff_t>(best - 1, 0));
  const double high =
      first + step * static_cast<double>(std::min<std::ptrdiff_t>(best + 1, kWidths - 1));
  return Minimize([&](double log_width) { return LeastMoment(points, std::exp(log_width)); }, low,
                  high, 0.02);
}

// One width and then the other, from equal ones on.
LobeWidths BestWidths(const std::vector<Point>& points, double log_width) {
  constexpr int kRounds = 4;
  const double low = std::log(LobeProposal::kLeastWidth), high = std::log(LobeProposal::kMostWidth);
  double x = log_width, y = log_width;
  for (double reach = 1.5; reach > 1.5 / (1 << kRounds); reach *= 0.5) {
    const auto search = [&](double* width) {
      const double center = *width;
      *width = Minimize(
          [&](double trial) {
            *width = trial;
            return LeastMoment(points, {std::exp(x), std::exp(y)});
          },
          std::max(low, center - reach), std::min(high, center + reach), 0.05 * reach);
    };
    search(&x);
    search(&y);
  }
  return {std::exp(x), std::exp(y)};
}

}  // namespace

LobeProposal FitLobeProposal(const Brdf& brdf) {
  const std::vector<Point> points = PointsOf(brdf);
  LobeProposal proposal;
  proposal.lobe_weight = 0.0;
  if (points.empty()) return proposal;
  const double log_width = BestLogWidth(points);
  proposal.alpha =
      brdf.IsIsotropic() ? LobeWidths(std::exp(log_width)) : BestWidths(points, log_width);
  const auto within = [](double alpha) {
    return std::clamp(alpha, LobeProposal::kLeastWidth, LobeProposal::kMostWidth);
  };
  proposal.alpha = {within(proposal.alpha.x), within(proposal.alpha.y)};
  proposal.lobe_weight = Moment(points, proposal.alpha).BestWeight();
  return proposal;
}

}  // namespace pbnbrdf
