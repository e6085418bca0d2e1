#include "pbnbrdf/brdf/merl.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "MERL files are little-endian");

constexpr double kPi = std::numbers::pi;
constexpr std::array<double, 3> kScale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::array<std::int32_t, 3> kDimensions = {MerlBrdf::kThetaH, MerlBrdf::kThetaD,
                                                     MerlBrdf::kPhiD};
constexpr std::size_t kHeaderBytes = sizeof(kDimensions);
constexpr std::size_t kFileBytes = kHeaderBytes + 3 * MerlBrdf::kBins * sizeof(double);
constexpr double kSmallestCosine = 1e-4;  // of a tabulated bin's corner

std::size_t BinIndex(int theta_h, int theta_d, int phi_d) {
  return (static_cast<std::size_t>(theta_h) * MerlBrdf::kThetaD + theta_d) * MerlBrdf::kPhiD +
         phi_d;
}

RusinkiewiczAngles CornerAngles(int theta_h, int theta_d, int phi_d) {
  return {.theta_h = MerlBrdf::RowAngle(theta_h),
          .theta_d = 0.5 * kPi * theta_d / MerlBrdf::kThetaD,
          .phi_d = kPi * phi_d / MerlBrdf::kPhiD};
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

TablePosition Locate(const DirectionPair& pair) {
  const RusinkiewiczAngles angles = ToAngles(pair);
  const double phi_d = angles.phi_d < kPi ? angles.phi_d : angles.phi_d - kPi;
  return {Clamped(MerlBrdf::kThetaH * std::sqrt(angles.theta_h / (0.5 * kPi)), MerlBrdf::kThetaH),
          Clamped(MerlBrdf::kThetaD * angles.theta_d / (0.5 * kPi), MerlBrdf::kThetaD),
          Periodic(MerlBrdf::kPhiD * phi_d / kPi, MerlBrdf::kPhiD)};
}

}  // namespace

double MerlBrdf::RowAngle(int row) {
  const double u = double(row) / kThetaH;
  return 0.5 * kPi * u * u;
}

MerlBrdf::MerlBrdf(std::vector<double> planes) : planes_(std::move(planes)) {
  for (std::size_t bin = 0; bin < kBins; ++bin) valid_bins_ += IsValid(bin);
}

MerlBrdf MerlBrdf::Read(const std::string& path) {
  const std::uintmax_t size = FileSize(path);
  if (size < kHeaderBytes) {
    Fail(path, ": not a MERL file: ", size, " bytes, shorter than its 12-byte header");
  }
  if (size > kFileBytes) {
    Fail(path, ": not a 90 x 90 x 180 MERL file: ", size, " bytes, expected ", kFileBytes);
  }
  const std::string bytes = ReadFile(path, kFileBytes);
  std::array<std::int32_t, 3> found;
  std::memcpy(found.data(), bytes.data(), kHeaderBytes);
  if (found != kDimensions) {
    Fail(path, ": not a MERL file: its header says ", found[0], " x ", found[1], " x ", found[2],
         ", expected 90 x 90 x 180");
  }
  if (size != kFileBytes) {
    Fail(path, ": truncated MERL file: ", size, " bytes, expected ", kFileBytes);
  }
  std::vector<double> planes(3 * kBins);
  std::memcpy(planes.data(), bytes.data() + kHeaderBytes, kFileBytes - kHeaderBytes);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (!std::isfinite(planes[i])) {
      Fail(path, ": damaged MERL file: channel ", "RGB"[i / kBins], " of bin ", i % kBins,
           " is not a finite number");
    }
  }
  MerlBrdf table(std::move(planes));
  if (table.valid_bins_ == 0) {
    Fail(path, ": no valid bin: all ", kBins, " have a negative channel");
  }
  return table;
}

MerlBrdf MerlBrdf::Tabulate(const Brdf& source) {
  if (!source.IsIsotropic()) {
    Fail(
        "anisotropic, and a MERL table has no phi_h: fit it as it is, or, for the nearest "
        "isotropic table, tabulate a fit with --encoding=merl");
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
          planes[c * kBins + BinIndex(h, d, p)] = values[p][c] / kScale[c];
        }
      }
    }
  }
  return MerlBrdf(std::move(planes));
}

std::string MerlBrdf::FileBytes() const {
  std::string bytes(kFileBytes, '\0');
  std::memcpy(bytes.data(), kDimensions.data(), kHeaderBytes);
  std::memcpy(bytes.data() + kHeaderBytes, planes_.data(), kFileBytes - kHeaderBytes);
  return bytes;
}

void MerlBrdf::Write(const std::string& path) const { WriteFile(path, FileBytes()); }

void MerlBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                 std::span<Rgb> values) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) values[n] = Interpolate(pairs[n]);
}

bool MerlBrdf::IsKnown(const DirectionPair& pair) const {
  const TablePosition at = Locate(pair);
  return pair.AboveHorizon() &&
         IsValid(BinIndex(at.theta_h.lower, at.theta_d.lower, at.phi_d.lower));
}

std::string MerlBrdf::Description() const {
  return StrCat("MERL table 90 x 90 x 180, ", valid_bins_, " of ", kBins, " bins valid");
}

bool MerlBrdf::IsValid(std::size_t bin) const {
  return Stored(0, bin) >= 0.0 && Stored(1, bin) >= 0.0 && Stored(2, bin) >= 0.0;
}

Rgb MerlBrdf::Interpolate(const DirectionPair& pair) const {
  const TablePosition at = Locate(pair);
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
        BinIndex(index(at.theta_h, 4), index(at.theta_d, 2), index(at.phi_d, 1));
    if (w <= 0.0 || !IsValid(bin)) continue;
    total += w;
    for (int c = 0; c < 3; ++c) sum[c] += w * kScale[c] * Stored(c, bin);
  }
  if (total <= 0.0) return {};
  for (double& value : sum) value = std::min(value / total, kLargestValue);
  return sum;
}

}  // namespace pbnbrdf
