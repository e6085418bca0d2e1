#include "sources/direction_columns.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSlack = 1e-3;  // of angles' ranges, radians: rounding
constexpr std::array<const char*, 4> kAngles = {"theta_i", "phi_i", "theta_o", "phi_o"};
constexpr std::array<const char*, 6> kVectors = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

}  // namespace

std::optional<DirectionColumns> DirectionColumns::Find(const TextTable& table) {
  DirectionColumns columns;
  for (const char* name : kAngles) {
    if (const auto at = table.FindColumn(name)) {
      columns.angles_.push_back({*at, 1.0});
    } else if (const auto degrees = table.FindColumn(StrCat(name, "_deg"))) {
      columns.angles_.push_back({*degrees, kPi / 180.0});
    }
  }
  if (columns.angles_.size() == kAngles.size()) return columns;
  columns.angles_.clear();
  for (const char* name : kVectors) {
    const auto at = table.FindColumn(name);
    if (!at) return std::nullopt;
    columns.vectors_.push_back({*at, 1.0});
  }
  return columns;
}

DirectionPair DirectionColumns::Parse(const TextTable& table) const {
  return angles_.empty() ? FromVectors(table) : FromAngles(table);
}

DirectionPair DirectionColumns::FromAngles(const TextTable& table) const {
  std::array<double, 4> angles;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const auto [at, scale] = angles_[k];
    angles[k] = scale * table.Number(at);
    const bool is_theta = k % 2 == 0;
    const double min = is_theta ? 0.0 : -2.0 * kPi, max = is_theta ? kPi : 2.0 * kPi;
    if (!(angles[k] >= min - kSlack && angles[k] <= max + kSlack)) {
      Fail(table.Place(), ", ", table.names()[at], ": ", table.cells()[at], " is ", angles[k],
           " radians; must be ", min, " to ", max, " (", kAngles[k], " is in radians, ", kAngles[k],
           "_deg in degrees)");
    }
  }
  return {FromSpherical(angles[0], angles[1]), FromSpherical(angles[2], angles[3])};
}

DirectionPair DirectionColumns::FromVectors(const TextTable& table) const {
  std::array<Vec3, 2> directions;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const auto number = [&](std::size_t c) { return table.Number(vectors_[3 * k + c].at); };
    const Vec3 v = {number(0), number(1), number(2)};
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0.0) || !std::isfinite(length)) {
      Fail(table.Place(), ": a direction has no length");
    }
    directions[k] = {v.x / length, v.y / length, v.z / length};
  }
  return {directions[0], directions[1]};
}

}  // namespace pbnbrdf
