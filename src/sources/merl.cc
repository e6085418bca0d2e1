#include "pbnbrdf/sources/merl.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/brdf/merl_rows.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "MERL files are little-endian");

constexpr double kPi = std::numbers::pi;
constexpr std::array<double, 3> kScale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::size_t kHeaderBytes = 3 * sizeof(std::int32_t);
constexpr std::size_t kBinBytes = 3 * sizeof(double);
constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;
constexpr double kSmallestCosine = 1e-4;  // of a tabulated bin's corner

std::size_t BinIndex(const MerlGrid& grid, int theta_h, int theta_d, int phi_d) {
  return (static_cast<std::size_t>(theta_h) * grid.theta_d + theta_d) * grid.phi_d + phi_d;
}

double PhiRange(const MerlGrid& grid) { return grid.WholeCircle() ? 2.0 * kPi : kPi; }

// Of a bin of the database's own grid.
RusinkiewiczAngles CornerAngles(int theta_h, int theta_d, int phi_d) {
  return {.theta_h = MerlRowAngle(theta_h),
          .theta_d = 0.5 * kPi * theta_d / MerlBrdf::kThetaD,
          .phi_d = kPi * phi_d / MerlBrdf::kPhiD};
}

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
  std::vector<double> planes(3 * kBins, -1.0);
  std::vector<DirectionPair> pairs(kPhiD);
  std::vector<Rgb> values(kPhiD);
  for (int h = 0; h < kThetaH; ++h) {
    for (int d = 0; d < kThetaD; ++d) {
      for (int p = 0; p < kPhiD; ++p) pairs[p] = FromAngles(CornerAngles(h, d, p));
      source.Evaluate(pairs, values);
      for (int p = 0; p < kPhiD; ++p) {
        const auto& [wi, wo] = pairs[p];
        if (std::min(wi.z, wo.z) <= kSmallestCosine || !source.IsKnown(pairs[p])) continue;
        for (int c = 0; c < 3; ++c) {
          planes[c * kBins + BinIndex({}, h, d, p)] = values[p][c] / kScale[c];
        }
      }
    }
  }
  return MerlBrdf({}, std::move(planes));
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
  const TablePosition at = Locate(grid_, pair);
  Rgb sum = {};
  double total = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto weight = [&](const AxisPosition& axis, int bit) {
      return corner & bit ? axis.upper_weight : 1.0 - axis.upper_weight;
    };
    const auto index = [&](const AxisPosition& axis, int bit) {
      return corner & bit ? axis.upper : axis.lower;
    };
    const double w = weight(at.theta_h, 4) * weight(at.theta_d, 2) * weight(at.phi_d, 1);
    const std::size_t bin =
        BinIndex(grid_, index(at.theta_h, 4), index(at.theta_d, 2), index(at.phi_d, 1));
    if (w <= 0.0 || !IsValid(bin)) continue;
    total += w;
    for (int c = 0; c < 3; ++c) sum[c] += w * kScale[c] * Stored(c, bin);
  }
  if (total <= 0.0) return {};
  for (double& value : sum) value = std::min(value / total, kLargestValue);
  return sum;
}

}  // namespace pbnbrdf
