// ReadAlta of scattered_files.h.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "sources/make_scattered.h"
#include "sources/text_table.h"

namespace pbnbrdf {
namespace {

constexpr double kMaxAngle = 2.0 * std::numbers::pi + 1e-3;
constexpr long kMaxDimensions = 64;

struct Parametrization {
  std::string_view name;
  long dimensions;
  bool isotropic;  // has no phi_h
  DirectionPair (*pair)(std::span<const double> x);
};

DirectionPair FromSphericalPair(double theta_l, double phi_l, double theta_v, double phi_v) {
  return {FromSpherical(theta_l, phi_l), FromSpherical(theta_v, phi_v)};
}

Vec3 Unit(const Vec3& v) { return (1.0 / Length(v)) * v; }

using Coordinates = std::span<const double>;
constexpr Parametrization kParametrizations[] = {
    {"ISOTROPIC_TL_TV_PROJ_DPHI", 3, true,
     [](Coordinates x) {
       return FromSphericalPair(x[0], 0.0, std::hypot(x[1], x[2]), std::atan2(x[2], x[1]));
     }},
    {"ISOTROPIC_TV_TL_DPHI", 3, true,
     [](Coordinates x) { return FromSphericalPair(x[1], 0.0, x[0], x[2]); }},
    {"SPHERICAL_TL_PL_TV_PV", 4, false,
     [](Coordinates x) { return FromSphericalPair(x[0], x[1], x[2], x[3]); }},
    {"RUSIN_TH_TD_PD", 3, true,
     [](Coordinates x) { return FromAngles({.theta_h = x[0], .theta_d = x[1], .phi_d = x[2]}); }},
    {"RUSIN_TH_PH_TD_PD", 4, false,
     [](Coordinates x) {
       return FromAngles({.theta_h = x[0], .theta_d = x[2], .phi_d = x[3], .phi_h = x[1]});
     }},
    {"COS_TH", 1, true,
     [](Coordinates x) { return FromAngles({.theta_h = std::acos(std::clamp(x[0], -1.0, 1.0))}); }},
    {"CARTESIAN", 6, false,
     [](Coordinates x) {
       return DirectionPair{Unit({x[3], x[4], x[5]}), Unit({x[0], x[1], x[2]})};
     }},
};

const Parametrization& FindParametrization(const std::string& place, std::string_view name) {
  std::string names;
  for (const Parametrization& known : kParametrizations) {
    if (known.name == name) return known;
    names += StrCat(names.empty() ? "" : " | ", known.name);
  }
  Fail(place, ": #PARAM_IN ", name, " is not one of ", names);
}

// What the lines with # say, together with where each stood.
class Header {
 public:
  void Take(const TextTable& table) {
    const auto& words = table.cells();
    if (words[0] == "#") return;  // "# a comment"
    entries_[std::string(words[0].substr(1))] = {table.Place(), {words.begin() + 1, words.end()}};
  }

  // As many words as there must be; `otherwise` if there is no such line and that isn't empty.
  std::vector<std::string> Get(const std::string& path, const std::string& key, std::size_t words,
                               const std::vector<std::string>& otherwise) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) {
      if (otherwise.empty()) Fail(path, ": not an ALTA file: no line #", key);
      return otherwise;
    }
    const auto& [place, values] = found->second;
    if (values.size() != words) {
      Fail(place, ": #", key, " is followed by ", values.size(), " words, expected ", words);
    }
    return values;
  }

 private:
  struct Entry {
    std::string place;
    std::vector<std::string> values;
  };
  std::map<std::string, Entry> entries_;
};

// The header, understood.
struct Layout {
  const Parametrization* coordinates;
  long channels, columns;
  bool cosine_weighted;
};

Layout Understand(const std::string& path, const Header& header) {
  Layout layout = {};
  const auto dimensions = header.Get(path, "DIM", 2, {});
  const auto number = [&](const std::string& key, const std::string& text, long least, long most) {
    const long value = ParseInteger(StrCat(path, ": #", key), text);
    if (value < least || value > most) {
      Fail(path, ": #", key, " ", value, "; must be ", least, " to ", most);
    }
    return value;
  };
  layout.coordinates = &FindParametrization(path, header.Get(path, "PARAM_IN", 1, {})[0]);
  const long coordinates = number("DIM", dimensions[0], 1, kMaxDimensions);
  if (coordinates != layout.coordinates->dimensions) {
    Fail(path, ": #DIM says ", coordinates, " coordinates, ", layout.coordinates->name, " has ",
         layout.coordinates->dimensions);
  }
  layout.channels = number("DIM", dimensions[1], 1, 3);
  if (layout.channels == 2) Fail(path, ": #DIM says 2 values; must be 1 or 3");
  layout.columns =
      coordinates + layout.channels + number("VS", header.Get(path, "VS", 1, {"0"})[0], 0, 2);
  const std::string format = header.Get(path, "FORMAT", 1, {"text"})[0];
  if (format != "text") Fail(path, ": #FORMAT ", format, "; only text is read");
  const std::string output = header.Get(path, "PARAM_OUT", 1, {"UNKNOWN_OUTPUT"})[0];
  const NameTable<bool, 4> kOutputs = {{{"INV_STERADIAN", false},
                                        {"RGB_COLOR", false},
                                        {"UNKNOWN_OUTPUT", false},
                                        {"INV_STERADIAN_COSINE_FACTOR", true}}};
  layout.cosine_weighted = ParseName(kOutputs, StrCat(path, ": #PARAM_OUT"), output);
  return layout;
}

BrdfSample ParseRow(const TextTable& table, const Layout& layout) {
  const std::string place = table.Place();
  table.RequireCells(static_cast<std::size_t>(layout.columns), "numbers");
  std::vector<double> row;
  for (std::size_t k = 0; k < table.cells().size(); ++k) row.push_back(table.Number(k));
  const auto coordinates = std::span(row).first(layout.coordinates->dimensions);
  for (double x : coordinates) {
    if (std::abs(x) > kMaxAngle) Fail(place, ": ", x, " isn't an angle in radians");
  }
  BrdfSample sample;
  sample.pair = layout.coordinates->pair(coordinates);
  const auto& [wi, wo] = sample.pair;
  if (!std::isfinite(wi.z + wo.z)) Fail(place, ": a direction has no length");
  for (long c = 0; c < 3; ++c) {
    const double value = row[coordinates.size() + std::min(c, layout.channels - 1)];
    sample.value[c] = layout.cosine_weighted && wo.z > 0.0 ? value / wo.z : value;
  }
  return sample;
}

}  // namespace

bool LooksLikeAlta(std::string_view start) {
  return start.starts_with("#") &&
         (start.starts_with("#DIM") || start.find("\n#DIM") != start.npos);
}

ScatteredBrdf ReadAlta(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kBlanks);
  Header header;
  Layout layout = {};
  ScatteredData data;
  bool in_header = true;
  while (table.Next()) {
    if (table.IsComment()) {
      if (in_header) header.Take(table);
      continue;
    }
    if (in_header) layout = Understand(path, header);
    in_header = false;
    data.samples.push_back(ParseRow(table, layout));
  }
  if (in_header) Fail(path, ": no measurements in it");
  data.kind = StrCat("ALTA measurements in ", layout.coordinates->name);
  data.channels = static_cast<int>(layout.channels);
  data.isotropic = layout.coordinates->isotropic || HaveOneIncidentAzimuth(data.samples);
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
