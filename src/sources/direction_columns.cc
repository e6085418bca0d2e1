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
constexpr std::array<const char*, 4> kDegrees = {"theta_i_deg", "phi_i_deg", "theta_o_deg",
                                                 "phi_o_deg"};
constexpr std::array<const char*, 6> kVectors = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

}  // namespace

std::optional<DirectionColumns> DirectionColumns::Find(TextTable* table) {
  table->NameColumns();
  const std::vector<std::size_t> radians = table->FindColumns(kAngles),
                                 degrees = table->FindColumns(kDegrees),
                                 vectors = table->FindColumns(kVectors);
  const bool has_vectors = vectors.size() == kVectors.size();
  if (!has_vectors && radians.size() + degrees.size() < kAngles.size()) {
    table->ForgetNames();
    return std::nullopt;
  }
  if (!radians.empty() && !degrees.empty()) {
    Fail(table->path(), ": columns ", table->names()[radians.front()], " in radians and ",
         table->names()[degrees.front()], " in degrees; write all angles in one of them");
  }
  if (has_vectors && !(radians.empty() && degrees.empty())) {
    Fail(table->path(), ": directions as angles and as vectors; leave out one of them");
  }
  DirectionColumns columns;
  columns.scale_ = degrees.empty() ? 1.0 : kDegree;
  columns.angles_ = degrees.empty() ? radians : degrees;
  if (has_vectors) columns.vectors_ = vectors;
  return columns;
}

bool DirectionColumns::AreMissing(const TextTable& table) const {
  const auto& columns = angles_.empty() ? vectors_ : angles_;
  return std::any_of(columns.begin(), columns.end(),
                     [&](std::size_t column) { return table.IsMissing(column); });
}

DirectionPair DirectionColumns::Parse(const TextTable& table) const {
  return angles_.empty() ? FromVectors(table) : FromAngles(table);
}

DirectionPair DirectionColumns::FromAngles(const TextTable& table) const {
  std::array<double, 4> angles;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    angles[k] = scale_ * table.Number(angles_[k]);
  }
  return PairFromAngles(table.Place(), angles,
                        " (theta_i is in radians, theta_i_deg in degrees; so are the others)");
}

DirectionPair DirectionColumns::FromVectors(const TextTable& table) const {
  std::array<Vec3, 2> directions;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const auto number = [&](std::size_t c) { return table.Number(vectors_[3 * k + c]); };
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
