#include "pbnbrdf/brdf/scattered.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "brdf/point_tree.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

constexpr double kSmallestCosine = 1e-4;
constexpr std::size_t kNeighbors = 8;
// Squared distance of measurements at one place: rounding of their angles.
constexpr double kSamePlace = 1e-20;

ScatteredData Usable(ScatteredData data) {
  data.left_out += std::erase_if(data.samples, [](const BrdfSample& s) {
    return !(std::min(s.pair.wi.z, s.pair.wo.z) > kSmallestCosine && IsUsable(s));
  });
  if (data.samples.empty()) {
    Fail("no data: of ", data.left_out,
         " measurements none has both directions above the horizon and a usable value");
  }
  for (BrdfSample& sample : data.samples) {
    for (double& value : sample.value) value = std::min(value, Brdf::kLargestValue);
  }
  return data;
}

// The samples' places and, behind them, those of mirror images; samples: which one each stands for.
std::vector<PointTree::Point> PlacesOf(const ScatteredData& data,
                                       std::vector<std::size_t>* samples) {
  std::vector<PointTree::Point> places;
  for (const BrdfSample& s : data.samples) {
    samples->push_back(places.size());
    places.push_back(ScatteredPlace(s.pair, data.isotropic));
  }
  if (!data.isotropic) return places;
  const PointTree measured(places);
  constexpr double kGap = ScatteredBrdf::kMirrorGap;
  for (std::size_t n = 0; n < data.samples.size(); ++n) {
    PointTree::Point image = places[n];
    image[3] = -image[3];
    if (measured.Nearest(image, 1).front().squared_distance <= kGap * kGap) continue;
    samples->push_back(n);
    places.push_back(image);
  }
  return places;
}

// Weights of all neighbours but the last, whose distance is where weights end; unless some are
// at the very place: then these have all the weight.
double ShepardWeight(double squared, double nearest, double farthest) {
  if (nearest <= kSamePlace) return squared <= kSamePlace ? 1.0 : 0.0;
  const double distance = std::sqrt(squared), end = std::sqrt(farthest);
  const double weight = (end - distance) / (end * distance);
  return weight * weight;
}

}  // namespace

std::array<double, 4> ScatteredPlace(const DirectionPair& pair, bool isotropic) {
  const auto [h, d] = ToHalfDiff(pair);
  const double sin_h = std::hypot(h.x, h.y), sin_d = std::hypot(d.x, d.y);
  const double r = std::sqrt(2.0 * std::atan2(sin_h, h.z) / std::numbers::pi);
  const double q = 2.0 * std::atan2(sin_d, d.z) / std::numbers::pi;
  const double cos_phi_h = sin_h > 0.0 ? h.x / sin_h : 1.0;
  const double sin_phi_h = sin_h > 0.0 ? h.y / sin_h : 0.0;
  // (x, y) of length q at twice the azimuth of (dx, dy): the same bits for (-dx, -dy).
  const auto doubled = [&](double dx, double dy) {
    const double scale = sin_d > 0.0 ? q / (sin_d * sin_d) : 0.0;
    return std::pair(scale * (dx * dx - dy * dy), scale * (2.0 * dx * dy));
  };
  if (isotropic) {
    const auto [x, y] = doubled(d.x, d.y);
    return {r, q, r * x, r * y};
  }
  const auto [x, y] = doubled(d.x * cos_phi_h - d.y * sin_phi_h, d.x * sin_phi_h + d.y * cos_phi_h);
  return {r * cos_phi_h, r * sin_phi_h, x, y};
}

std::array<double, 4> MirroredPlace(const DirectionPair& pair, bool isotropic) {
  std::array<double, 4> place = ScatteredPlace(pair, isotropic);
  if (isotropic) place[3] = std::abs(place[3]);
  return place;
}

ScatteredBrdf::ScatteredBrdf(ScatteredData data)
    : data_(Usable(std::move(data))),
      tree_(std::make_shared<PointTree>(PlacesOf(data_, &samples_))) {}

void ScatteredBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                      std::span<Rgb> values) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const auto near = tree_->Nearest(ScatteredPlace(pairs[n], data_.isotropic), kNeighbors + 1);
    const double nearest = near.front().squared_distance, farthest = near.back().squared_distance;
    Rgb sum = {};
    double total = 0.0;
    for (const auto& [squared, index] : near) {
      const double weight = ShepardWeight(squared, nearest, farthest);
      total += weight;
      for (int c = 0; c < 3; ++c) sum[c] += weight * data_.samples[samples_[index]].value[c];
    }
    // All equally far: none has a weight.
    values[n] = total > 0.0 ? Rgb{sum[0] / total, sum[1] / total, sum[2] / total}
                            : data_.samples[samples_[near.front().index]].value;
  }
}

double ScatteredBrdf::SquaredDistance(const DirectionPair& pair) const {
  return tree_->Nearest(ScatteredPlace(pair, data_.isotropic), 1).front().squared_distance;
}

bool ScatteredBrdf::IsKnown(const DirectionPair& pair) const {
  return pair.AboveHorizon() && SquaredDistance(pair) <= kReach * kReach;
}

double ScatteredBrdf::Certainty(const DirectionPair& pair) const {
  constexpr double kHalf = kReach / 4.0;
  return 1.0 / (1.0 + SquaredDistance(pair) / (kHalf * kHalf));
}

std::vector<double> ScatteredBrdf::IncidentAngles() const {
  std::vector<double> all, angles;
  for (const BrdfSample& sample : data_.samples) all.push_back(Theta(sample.pair.wi));
  std::sort(all.begin(), all.end());
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::upper_bound(begin, all.end(), *begin + kSameIncidence);
    if (static_cast<std::size_t>(end - begin) >= kLeastAtAngle) {
      angles.push_back(begin[(end - begin) / 2]);
    }
    begin = end;
  }
  return angles;
}

std::unique_ptr<Brdf> ScatteredBrdf::WithoutIncidentAngle(std::size_t index) const {
  const double angle = IncidentAngles()[index];
  ScatteredData rest = data_;
  std::erase_if(rest.samples, [&](const BrdfSample& sample) {
    return std::abs(Theta(sample.pair.wi) - angle) <= kSameIncidence;
  });
  return std::make_unique<ScatteredBrdf>(std::move(rest));
}

std::string ScatteredBrdf::Description() const {
  const std::string rest =
      data_.left_out > 0 ? StrCat(", ", data_.left_out, " unusable ones left out") : "";
  return StrCat(data_.kind, ", ", data_.isotropic ? "isotropic" : "anisotropic", ", ",
                data_.channels == 1 ? "one channel" : "RGB", ", ", data_.samples.size(),
                " measurements", rest);
}

}  // namespace pbnbrdf
