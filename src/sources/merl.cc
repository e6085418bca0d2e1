#include "pbnbrdf/sources/merl.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/pi.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/brdf/merl_rows.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "MERL files are little-endian");

constexpr std::array<double, 3> kScale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::size_t kHeaderBytes = 3 * sizeof(std::int32_t);
constexpr std::size_t kBinBytes = 3 * sizeof(double);
constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;
constexpr double kSmallestCosine = 1e-4;  // of a tabulated bin's corner

std::size_t BinIndex(const MerlGrid& grid, int theta_h, int theta_d, int phi_d) {
  return (static_cast<std::size_t>(theta_h) * grid.theta_d + theta_d) * grid.phi_d + phi_d;
}

double PhiRange(const MerlGrid& grid) { return grid.WholeCircle() ? 2.0 * kPi : kPi; }

std::string GridText(const MerlGrid& grid) {
  return StrCat(grid.theta_h, " x ", grid.theta_d, " x ", grid.phi_d);
}

// The header's grid. Throws Error unless the file's size is what it asks for.
MerlGrid ParseHeader(const std::string& path, const std::string& header, std::uintmax_t size) {
  std::array<std::int32_t, 3> found;
  std::memcpy(found.data(), header.data(), kHeaderBytes);
  const MerlGrid grid = {found[0], found[1], found[2]};
  if (*std::min_element(found.begin(), found.end()) < 1) {
    Fail(path, ": not a MERL file: its header says ", GridText(grid),
         ", such as 90 x 90 x 180 was expected");
  }
  // Each is less than 2^31: no overflow in double, and none in integers once it fits.
  const double wanted = double(kHeaderBytes) + double(kBinBytes) * found[0] * found[1] * found[2];
  if (wanted > double(kLargestFile)) {
    Fail(path, ": not a MERL file: its header says ", GridText(grid), ", too large a table");
  }
  const std::size_t expected = kHeaderBytes + kBinBytes * grid.bins();
  if (size != expected) {
    Fail(path, size < expected ? ": truncated MERL file: " : ": not a MERL file: ", size,
         " bytes, expected ", expected, " for the header's ", GridText(grid));
  }
  return grid;
}

// Where a coordinate lies on an axis: bin `lower` and the weight of the next one.
struct AxisPosition {
  int lower, upper;
  double upper_weight;
};

// The last bin has no upper corner: it is constant.
AxisPosition Clamped(double x, int size) {
  const int lower = std::clamp(static_cast<int>(x), 0, size - 1);
  if (lower == size - 1) return {lower, lower, 0.0};
  return {lower, lower + 1, std::clamp(x - lower, 0.0, 1.0)};
}

AxisPosition Periodic(double x, int size) {
  const int lower = std::clamp(static_cast<int>(x), 0, size - 1);
  return {lower, (lower + 1) % size, std::clamp(x - lower, 0.0, 1.0)};
}

struct TablePosition {
  AxisPosition theta_h, theta_d, phi_d;
};

TablePosition Locate(const MerlGrid& grid, const DirectionPair& pair) {
  const RusinkiewiczAngles angles = ToAngles(pair);
  const double range = PhiRange(grid);
  const double phi_d = angles.phi_d < range ? angles.phi_d : angles.phi_d - range;
  return {Clamped(grid.theta_h * std::sqrt(angles.theta_h / (0.5 * kPi)), grid.theta_h),
          Clamped(grid.theta_d * angles.theta_d / (0.5 * kPi), grid.theta_d),
          Periodic(grid.phi_d * phi_d / range, grid.phi_d)};
}

}  // namespace

std::array<TableCorner, 8> CornersOf(const MerlGrid& grid, const DirectionPair& pair) {
  const TablePosition at = Locate(grid, pair);
  const auto weight = [](const AxisPosition& axis, bool upper) {
    return upper ? axis.upper_weight : 1.0 - axis.upper_weight;
  };
  const auto index = [](const AxisPosition& axis, bool upper) {
    return upper ? axis.upper : axis.lower;
  };
  std::array<TableCorner, 8> corners;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const bool h = k & 4, d = k & 2, p = k & 1;
    corners[k] = {BinIndex(grid, index(at.theta_h, h), index(at.theta_d, d), index(at.phi_d, p)),
                  weight(at.theta_h, h) * weight(at.theta_d, d) * weight(at.phi_d, p)};
  }
  return corners;
}

MerlBrdf::MerlBrdf(const MerlGrid& grid, std::vector<double> planes)
    : grid_(grid), planes_(std::move(planes)) {
  for (std::size_t bin = 0; bin < grid_.bins(); ++bin) valid_bins_ += IsValid(bin);
}

MerlBrdf MerlBrdf::Read(const std::string& path) {
  const std::uintmax_t size = FileSize(path);
  if (size < kHeaderBytes) {
    Fail(path, ": not a MERL file: ", size, " bytes, shorter than its 12-byte header");
  }
  const MerlGrid grid = ParseHeader(path, ReadStart(path, kHeaderBytes), size);
  const std::size_t bins = grid.bins();
  const std::string bytes = ReadFile(path, size);
  std::vector<double> planes(3 * bins);
  std::memcpy(planes.data(), bytes.data() + kHeaderBytes, kBinBytes * bins);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (!std::isfinite(planes[i])) {
      Fail(path, ": damaged MERL file: channel ", "RGB"[i / bins], " of bin ", i % bins,
           " is not a finite number");
    }
  }
  MerlBrdf table(grid, std::move(planes));
  if (table.valid_bins_ == 0) {
    Fail(path, ": no valid bin: all ", bins, " hold one negative number in all channels");
  }
  return table;
}

MerlBrdf MerlBrdf::Tabulate(const Brdf& source) {
  if (!source.IsIsotropic()) {
    Fail(
        "anisotropic, and a MERL table has no phi_h: fit it as it is, or, for the nearest "
        "isotropic table, export a fit made with --encoding=merl");
  }
  std::vector<BinValue> known;
  std::vector<DirectionPair> pairs;
  for (const std::size_t bin : BinsAboveHorizon()) {
    const DirectionPair pair = CornerPair(bin);
    if (!source.IsKnown(pair)) continue;
    known.push_back({bin, {}});
    pairs.push_back(pair);
  }
  std::vector<Rgb> values(pairs.size());
  source.Evaluate(pairs, values);
  for (std::size_t n = 0; n < values.size(); ++n) known[n].value = values[n];
  return FromValues(known);
}

MerlBrdf MerlBrdf::FromValues(std::span<const BinValue> values) {
  std::vector<double> planes(3 * kBins, -1.0);
  for (const auto& [bin, value] : values) {
    for (std::size_t c = 0; c < 3; ++c) planes[c * kBins + bin] = value[c] / kScale[c];
  }
  return MerlBrdf({}, std::move(planes));
}

std::vector<std::size_t> MerlBrdf::BinsAboveHorizon() {
  std::vector<std::size_t> bins;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const auto [wi, wo] = CornerPair(bin);
    if (std::min(wi.z, wo.z) > kSmallestCosine) bins.push_back(bin);
  }
  return bins;
}

DirectionPair MerlBrdf::CornerPair(std::size_t bin) {
  const auto phi_d = static_cast<double>(bin % kPhiD);
  const auto theta_d = static_cast<double>(bin / kPhiD % kThetaD);
  return FromAngles({.theta_h = MerlRowAngle(static_cast<int>(bin / (kPhiD * kThetaD))),
                     .theta_d = 0.5 * kPi * theta_d / kThetaD,
                     .phi_d = kPi * phi_d / kPhiD});
}

MerlBrdf MerlBrdf::Changed(const std::function<double(double f)>& change) const {
  std::vector<double> planes = planes_;
  for (std::size_t bin = 0; bin < grid_.bins(); ++bin) {
    if (!IsValid(bin)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      double& stored = planes[c * grid_.bins() + bin];
      stored = change(stored * kScale[c]) / kScale[c];
    }
  }
  return MerlBrdf(grid_, std::move(planes));
}

std::string MerlBrdf::FileBytes() const {
  const std::array<std::int32_t, 3> header = {grid_.theta_h, grid_.theta_d, grid_.phi_d};
  const std::size_t table_bytes = kBinBytes * grid_.bins();
  std::string bytes(kHeaderBytes + table_bytes, '\0');
  std::memcpy(bytes.data(), header.data(), kHeaderBytes);
  std::memcpy(bytes.data() + kHeaderBytes, planes_.data(), table_bytes);
  return bytes;
}

void MerlBrdf::Write(const std::string& path) const { WriteFile(path, FileBytes()); }

void MerlBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                 std::span<Rgb> values) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) values[n] = Interpolate(pairs[n]);
}

bool MerlBrdf::IsKnown(const DirectionPair& pair) const {
  const TablePosition at = Locate(grid_, pair);
  return pair.AboveHorizon() &&
         IsValid(BinIndex(grid_, at.theta_h.lower, at.theta_d.lower, at.phi_d.lower));
}

std::string MerlBrdf::Description() const {
  std::size_t negative = 0;
  for (std::size_t bin = 0; bin < grid_.bins(); ++bin) {
    negative += IsValid(bin) && std::min({Stored(0, bin), Stored(1, bin), Stored(2, bin)}) < 0.0;
  }
  return StrCat("MERL table ", GridText(grid_), ", ", valid_bins_, " of ", grid_.bins(),
                " bins valid",
                negative > 0 ? StrCat(", ", negative, " with a negative channel") : "");
}

bool MerlBrdf::IsValid(std::size_t bin) const {
  const double r = Stored(0, bin);
  return r >= 0.0 || r != Stored(1, bin) || r != Stored(2, bin);
}

Rgb MerlBrdf::Interpolate(const DirectionPair& pair) const {
  Rgb sum = {};
  double total = 0.0;
  for (const auto& [bin, weight] : CornersOf(grid_, pair)) {
    if (weight <= 0.0 || !IsValid(bin)) continue;
    total += weight;
    for (int c = 0; c < 3; ++c) sum[c] += weight * kScale[c] * Stored(c, bin);
  }
  if (total <= 0.0) return {};
  for (double& value : sum) value = std::min(value / total, kLargestValue);
  return sum;
}

}  // namespace pbnbrdf
