#include "sources/direction_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "pbnbrdf/base/error.h"
#include "sources/angles.h"

namespace pbnbrdf {
namespace {

constexpr std::array<const char*, 4> kAngles = {"theta_i", "phi_i", "theta_o", "phi_o"};
constexpr std::array<const char*, 6> kVectors = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

}  // namespace

std::optional<DirectionColumns> DirectionColumns::Find(TextTable* table) {
  table->NameColumns();
  DirectionColumns columns;
  for (const char* name : kAngles) {
    if (const auto at = table->FindColumn(name)) {
      columns.angles_.push_back({*at, 1.0});
    } else if (const auto degrees = table->FindColumn(StrCat(name, "_deg"))) {
      columns.angles_.push_back({*degrees, kDegree});
    }
  }
  if (columns.angles_.size() == kAngles.size()) return columns;
  columns.angles_.clear();
  for (const char* name : kVectors) {
    const auto at = table->FindColumn(name);
    if (!at) {
      table->ForgetNames();
      return std::nullopt;
    }
    columns.vectors_.push_back({*at, 1.0});
  }
  return columns;
}

bool DirectionColumns::AreMissing(const TextTable& table) const {
  const auto& columns = angles_.empty() ? vectors_ : angles_;
  return std::any_of(columns.begin(), columns.end(),
                     [&](const Column& column) { return table.IsMissing(column.at); });
}

DirectionPair DirectionColumns::Parse(const TextTable& table) const {
  return angles_.empty() ? FromVectors(table) : FromAngles(table);
}

DirectionPair DirectionColumns::FromAngles(const TextTable& table) const {
  std::array<double, 4> angles;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    angles[k] = angles_[k].scale * table.Number(angles_[k].at);
  }
  return PairFromAngles(table.Place(), angles,
                        " (theta_i is in radians, theta_i_deg in degrees; so are the others)");
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
