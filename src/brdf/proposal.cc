// The tables of a Brdf's density (importance_sampler.h).
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/pi.h"
#include "brdf/half_vector_cells.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/albedo.h"

namespace pbnbrdf {
namespace {

constexpr double kThetas[] = {5.0, 20.0, 35.0, 50.0, 65.0, 78.0};  // degrees, to find the spread
constexpr double kLeastSpread = 1e-9, kMostSpread = 0.25;
constexpr int kInside = 2;  // points in a cell, each way
// The part of a table's samples that goes to cells in proportion to their size, as wi sees it.
constexpr double kEverywhere = 0.005;
constexpr double kShares[] = {0.0, 0.02, 0.05, 0.1, 0.2,  0.3,  0.4, 0.5,
                              0.6, 0.7,  0.8,  0.9, 0.95, 0.98, 1.0};

// R + G + B at each pair.
std::vector<double> Sums(const Brdf& brdf, const std::vector<DirectionPair>& pairs) {
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  std::vector<double> sums;
  for (const Rgb& value : values) {
    sums.push_back(value[0] + value[1] + value[2]);
    if (!std::isfinite(sums.back())) Fail("a value isn't finite: no proposal can be fitted");
  }
  return sums;
}

// The number that has such a share of the weights at or below it.
double WeightedQuantile(double share, std::vector<std::pair<double, double>> numbers_and_weights) {
  std::sort(numbers_and_weights.begin(), numbers_and_weights.end());
  double wanted = 0.0, sum = 0.0;
  for (const auto& [number, weight] : numbers_and_weights) wanted += share * weight;
  for (const auto& [number, weight] : numbers_and_weights) {
    sum += weight;
    if (sum >= wanted) return number;
  }
  return 0.0;
}

// The 1 - cos_h below which a tenth is of what is reflected, counted by its square.
double Spread(const Brdf& brdf, int azimuths) {
  const AlbedoQuadrature quadrature(48, 24);
  std::vector<std::pair<double, double>> depths;
  for (const double theta : kThetas) {
    for (int k = 0; k < azimuths; ++k) {
      const Vec3 wi = FromSpherical(theta * kPi / 180.0, k * kPi / azimuths);
      const std::vector<AlbedoNode> nodes = quadrature.Nodes(wi);
      std::vector<DirectionPair> pairs;
      for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
      const std::vector<double> sums = Sums(brdf, pairs);
      double albedo = 0.0;
      for (std::size_t n = 0; n < nodes.size(); ++n) albedo += nodes[n].weight * sums[n];
      if (!(albedo > 0.0)) continue;
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const double share = sums[n] / albedo;
        const Vec3 sum = wi + pairs[n].wo;
        depths.emplace_back(OneMinusCosine((1.0 / Length(sum)) * sum),
                            nodes[n].weight * pairs[n].wo.z * share * share);
      }
    }
  }
  if (depths.empty()) return kMostSpread;
  return std::clamp(WeightedQuantile(0.1, std::move(depths)), kLeastSpread, kMostSpread);
}

// Numbers at points of the cells, kInside^2 in each, cell by cell.
class CellValues {
 public:
  explicit CellValues(std::size_t points) : values_(points) {}

  double& operator[](std::size_t point) { return values_[point]; }
  double operator[](std::size_t point) const { return values_[point]; }
  std::size_t size() const { return values_.size(); }

  double OfCell(std::size_t cell) const {
    double sum = 0.0;
    for (int k = 0; k < kInside * kInside; ++k) sum += values_[cell * kInside * kInside + k];
    return sum;
  }

  // Afterwards the sum over all points is 1, unless it is 0.
  void Normalize() {
    double sum = 0.0;
    for (const double value : values_) sum += value;
    if (!(sum > 0.0)) return;
    for (double& value : values_) value /= sum;
  }

 private:
  std::vector<double> values_;
};

// Densities over the points of one incident direction's cells.
struct Table {
  explicit Table(std::size_t points) : reflected(points), cosine(points), visible(points) {}

  CellValues reflected;  // f cos_o
  CellValues cosine;     // cos_o
  CellValues visible;    // h, where it faces wi
};

Table Tabulate(const Brdf& brdf, const Proposal& p, const Vec3& wi) {
  const HalfVectorCells cells(p);
  const Vec3 axis = HalfVectorCells::Axis(p, wi);
  Table table(p.NumCells() * kInside * kInside);
  std::vector<DirectionPair> pairs;
  std::vector<std::size_t> points;
  for (std::size_t n = 0; n < table.visible.size(); ++n) {
    const int cell = static_cast<int>(n / (kInside * kInside)), inside = n % (kInside * kInside);
    const double u = (cell / p.sectors + (inside / kInside + 0.5) / kInside) / p.rings;
    const double v = (cell % p.sectors + (inside % kInside + 0.5) / kInside) / p.sectors;
    const Vec3 h = FromFrame(axis, cells.At(u, v));
    const double cos_d = Dot(wi, h);
    if (!(cos_d > 0.0)) continue;
    table.visible[n] = cos_d / cells.Density(1.0 - h.z);
    const DirectionPair pair = {wi, Reflected(wi, h)};
    if (!pair.AboveHorizon()) continue;
    table.cosine[n] = table.visible[n] * pair.wo.z;
    pairs.push_back(pair);
    points.push_back(n);
  }
  const std::vector<double> sums = Sums(brdf, pairs);
  for (std::size_t k = 0; k < points.size(); ++k) {
    table.reflected[points[k]] = sums[k] * table.cosine[points[k]];
  }
  table.reflected.Normalize();
  table.cosine.Normalize();
  table.visible.Normalize();
  return table;
}

// The cells' probabilities where the cosine has a share: what it leaves to be drawn.
std::vector<double> Remainder(const Table& table, std::size_t cells, double share) {
  std::vector<double> remainder(cells);
  double sum = 0.0;
  for (std::size_t k = 0; k < cells; ++k) {
    remainder[k] = std::max(0.0, table.reflected.OfCell(k) - share * table.cosine.OfCell(k));
    sum += remainder[k];
  }
  for (std::size_t k = 0; k < cells; ++k) {
    const double everywhere = table.visible.OfCell(k);
    remainder[k] = sum > 0.0 ? kEverywhere * everywhere + (1.0 - kEverywhere) * remainder[k] / sum
                             : everywhere;
  }
  return remainder;
}

// The second moment of f cos_o / p, from the points.
double Moment(const Table& table, const std::vector<double>& cells, double share) {
  constexpr double kPoints = kInside * kInside;
  double moment = 0.0;
  for (std::size_t n = 0; n < table.reflected.size(); ++n) {
    const double reflected = table.reflected[n];
    if (reflected == 0.0) continue;
    const double cell = cells[n / static_cast<std::size_t>(kPoints)] / kPoints;
    moment += reflected * reflected / (share * table.cosine[n] + (1.0 - share) * cell);
  }
  return moment;
}

// Appends the incident direction's share of the cosine and its cells.
void AddIncident(const Table& table, Proposal* proposal) {
  const auto count = static_cast<std::size_t>(proposal->NumCells());
  double best_share = 1.0, least = std::numeric_limits<double>::infinity();
  std::vector<double> best = Remainder(table, count, best_share);
  for (const double share : kShares) {
    std::vector<double> cells = Remainder(table, count, share);
    const double moment = Moment(table, cells, share);
    if (!(moment > 0.0 && moment < least)) continue;
    least = moment;
    best_share = share;
    best = std::move(cells);
  }
  proposal->cosine_share.push_back(static_cast<float>(best_share));
  for (const double cell : best) proposal->cells.push_back(static_cast<float>(cell));
}

}  // namespace

Proposal FitProposal(const Brdf& brdf) {
  const bool isotropic = brdf.IsIsotropic();
  Proposal proposal = isotropic ? Proposal{.cosines = 12, .azimuths = 1, .rings = 48, .sectors = 8}
                                : Proposal{.cosines = 8, .azimuths = 4, .rings = 32, .sectors = 48};
  proposal.spread = Spread(brdf, isotropic ? 1 : 3);
  for (int azimuth = 0; azimuth < proposal.azimuths; ++azimuth) {
    for (int k = 0; k < proposal.cosines; ++k) {
      const double cosine = (k + 1.0) / proposal.cosines;
      const Vec3 wi = FromSpherical(std::acos(cosine), kPi * (azimuth + 0.5) / proposal.azimuths);
      AddIncident(Tabulate(brdf, proposal, wi), &proposal);
    }
  }
  return proposal;
}

}  // namespace pbnbrdf
