// ReadScatteredCsv of scattered_files.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "sources/make_scattered.h"
#include "sources/text_lines.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSlack = 1e-3;  // of angles' ranges, radians: rounding
constexpr std::array<const char*, 4> kAngles = {"theta_i", "phi_i", "theta_o", "phi_o"};
constexpr std::array<const char*, 6> kVectors = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};
constexpr std::array<const char*, 3> kRgb = {"r", "g", "b"};
constexpr char kExpected[] =
    "theta_i,phi_i,theta_o,phi_o (radians; theta_i_deg, ...: degrees) or "
    "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z, and value or r,g,b";

// Where the columns stand, and what a number in them is multiplied by.
struct Column {
  std::size_t at;
  double scale;
  std::string name;
};

class Header {
 public:
  Header(const std::string& place, std::string_view line) : names_(Split(line, ',')) {
    for (const char* name : kAngles) {
      if (!AddIf(name, 1.0, &angles_)) AddIf(StrCat(name, "_deg"), kPi / 180.0, &angles_);
    }
    for (const char* name : kVectors) AddIf(name, 1.0, &vectors_);
    for (const char* name : kRgb) AddIf(name, 1.0, &values_);
    if (values_.size() != kRgb.size()) {
      values_.clear();
      AddIf("value", 1.0, &values_);
    }
    const bool has_angles = angles_.size() == kAngles.size();
    if (values_.empty() || (!has_angles && vectors_.size() != kVectors.size())) {
      Fail(place, ": the first line must name the columns ", kExpected);
    }
    if (!has_angles) angles_.clear();
  }

  int channels() const { return static_cast<int>(values_.size()); }

  BrdfSample Parse(const std::string& place, std::string_view line) const {
    const std::vector<std::string> row = Split(line, ',');
    if (row.size() != names_.size()) {
      Fail(place, ": ", row.size(), " columns, expected ", names_.size());
    }
    BrdfSample sample;
    sample.pair = angles_.empty() ? FromVectors(place, row) : FromAngles(place, row);
    for (std::size_t c = 0; c < 3; ++c) {
      sample.value[c] = Number(place, row, values_[std::min(c, values_.size() - 1)]);
    }
    return sample;
  }

 private:
  // False if there is no column of that name.
  bool AddIf(const std::string& name, double scale, std::vector<Column>* columns) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return false;
    columns->push_back({static_cast<std::size_t>(found - names_.begin()), scale, name});
    return true;
  }

  static double Number(const std::string& place, const std::vector<std::string>& row,
                       const Column& column) {
    return column.scale * ParseNumber(StrCat(place, ", ", column.name), row[column.at]);
  }

  DirectionPair FromAngles(const std::string& place, const std::vector<std::string>& row) const {
    std::array<double, 4> angles;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      angles[k] = Number(place, row, angles_[k]);
      const bool is_theta = k % 2 == 0;
      const double least = is_theta ? 0.0 : -2.0 * kPi, most = is_theta ? kPi : 2.0 * kPi;
      if (!(angles[k] >= least - kSlack && angles[k] <= most + kSlack)) {
        Fail(place, ", ", angles_[k].name, ": ", row[angles_[k].at], " is ", angles[k],
             " radians; must be ", least, " to ", most, " (", kAngles[k], " is in radians, ",
             kAngles[k], "_deg in degrees)");
      }
    }
    return {FromSpherical(angles[0], angles[1]), FromSpherical(angles[2], angles[3])};
  }

  DirectionPair FromVectors(const std::string& place, const std::vector<std::string>& row) const {
    std::array<Vec3, 2> directions;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const auto number = [&](std::size_t c) { return Number(place, row, vectors_[3 * k + c]); };
      const Vec3 v = {number(0), number(1), number(2)};
      const double length = std::hypot(v.x, v.y, v.z);
      if (!(length > 0.0) || !std::isfinite(length)) Fail(place, ": a direction has no length");
      directions[k] = {v.x / length, v.y / length, v.z / length};
    }
    return {directions[0], directions[1]};
  }

  std::vector<std::string> names_;
  std::vector<Column> angles_, vectors_, values_;
};

}  // namespace

ScatteredBrdf ReadScatteredCsv(const std::string& path) {
  TextLines lines(path);
  std::optional<Header> header;
  std::optional<bool> said_isotropic;
  ScatteredData data;
  std::string_view line;
  while (lines.Next(&line)) {
    if (line.starts_with("#")) {
      const std::string_view comment = Trim(line.substr(1));
      if (comment == "isotropic" || comment == "anisotropic") {
        said_isotropic = comment == "isotropic";
      }
    } else if (!header) {
      header.emplace(lines.Place(), line);
    } else {
      data.samples.push_back(header->Parse(lines.Place(), line));
    }
  }
  if (!header) Fail(path, ": no line that names the columns ", kExpected);
  data.kind = "CSV measurements";
  data.channels = header->channels();
  data.isotropic = said_isotropic.value_or(HaveOneIncidentAzimuth(data.samples));
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
