#include "pbnbrdf/sources/fred.h"

#include <array>
#include <optional>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/angles.h"
#include "sources/make_scattered.h"
#include "sources/text_table.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kType = "type bsdf_data";

// A line of the header: "type ..." or "format ...".
bool TakeHeader(const TextTable& table) {
  const std::string keyword = LowerCase(table.cells()[0]);
  if (keyword != "type" && keyword != "format") return false;
  for (std::size_t k = 1; k < table.cells().size(); ++k) {
    const std::string word = LowerCase(table.cells()[k]);
    const bool known = keyword == "type"
                           ? word == "bsdf_data"
                           : word == "angles=deg" || word == "bsdf=value" || word == "scale=1";
    if (!known) {
      Fail(table.Place(), ": ", keyword, " ", table.cells()[k],
           "; read are type bsdf_data and format angles=deg bsdf=value scale=1");
    }
  }
  return true;
}

BrdfSample ParseRow(const TextTable& table, const std::array<double, 2>& incident) {
  const double phi_i = kDegree * incident[1], theta_o = kDegree * table.Number(0),
               phi_s = kDegree * table.Number(1), f = table.Number(2);
  BrdfSample sample;
  sample.pair = PairFromAngles(table.Place(), {kDegree * incident[0], phi_i, theta_o, phi_s});
  sample.pair.wo = FromSpherical(theta_o, phi_i + std::numbers::pi + phi_s);
  sample.value = {f, f, f};
  return sample;
}

}  // namespace

bool LooksLikeFred(std::string_view start) { return LowerCase(Trim(start)).starts_with(kType); }

ScatteredBrdf ReadFred(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kBlanks);
  std::optional<std::array<double, 2>> incident;
  ScatteredData data;
  while (table.Next()) {
    if (table.IsComment() || TakeHeader(table)) continue;
    if (table.cells().size() == 2) {
      incident = {table.Number(0), table.Number(1)};
      continue;
    }
    table.RequireCells(3, "numbers");
    if (!incident) Fail(table.Place(), ": a row before the first incident direction");
    data.samples.push_back(ParseRow(table, *incident));
  }
  data.kind = "FRED measurements";
  data.channels = 1;
  data.isotropic = HaveOneIncidentAzimuth(data.samples);
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
