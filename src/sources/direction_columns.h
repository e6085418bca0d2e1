// direction_columns.h: the columns of a table that say where light comes from and where it goes:
// theta_i, phi_i, theta_o, phi_o in radians, or theta_i_deg, ... in degrees; or wi_x, wi_y, wi_z, wo_x, wo_y,
// wo_z, of any length but 0. A negative theta is on the other side of the normal: phi + pi.
#pragma once

#include <optional>
#include <vector>

#include "pbnbrdf/brdf/direction.h"
#include "sources/text_table.h"

namespace pbnbrdf {

inline constexpr char kDirectionColumns[] =
    "theta_i,phi_i,theta_o,phi_o (radians; theta_i_deg, ...: degrees) or "
    "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z";

class DirectionColumns {
 public:
  // Names the table's columns by its line. None, and the names forgotten, if directions aren't among them.
  // Throws Error if there is more than one reading: two columns with one of the names, radians and degrees,
  // angles and vectors.
  static std::optional<DirectionColumns> Find(TextTable* table);

  // Whether one of them is missing in the table's line.
  bool AreMissing(const TextTable& table) const;

  // Of the table's line. Throws Error if one isn't a number, not in its range, or a vector has no length.
  DirectionPair Parse(const TextTable& table) const;

 private:
  DirectionPair FromAngles(const TextTable& table) const;
  DirectionPair FromVectors(const TextTable& table) const;

  std::vector<std::size_t> angles_, vectors_;  // four or none; six or none
  double scale_;                               // what an angle is multiplied by
};

}  // namespace pbnbrdf
