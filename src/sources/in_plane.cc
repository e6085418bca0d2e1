#include "pbnbrdf/sources/in_plane.h"

#include <algorithm>
#include <array>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/angles.h"
#include "sources/make_scattered.h"
#include "sources/text_table.h"

namespace pbnbrdf {
namespace {

using Names = std::array<const char*, 5>;
constexpr Names kNames[] = {{"phi_in", "theta_in", "phi_out", "theta_out", "brdf"},
                            {"phi_i", "theta_i", "phi_o", "theta_o", "brdf"}};

// Goes to the line of names, which is a comment or the first line that isn't one.
bool FindNames(TextTable* table) {
  while (table->Next()) {
    table->NameColumns();
    const auto& found = table->names();
    for (const Names& names : kNames) {
      if (std::equal(names.begin(), names.end(), found.begin(), found.end(),
                     [](const char* a, const std::string& b) { return a == LowerCase(b); })) {
        return true;
      }
    }
    table->ForgetNames();
    if (!table->IsComment()) return false;
  }
  return false;
}

bool IsComplete(const TextTable& table) {
  for (std::size_t k = 0; k < table.names().size(); ++k) {
    if (table.IsMissing(k)) return false;
  }
  return true;
}

BrdfSample ParseRow(const TextTable& table) {
  const auto angle = [&](std::size_t column) { return kDegree * table.Number(column); };
  const double f = table.Number(4);
  BrdfSample sample;
  sample.pair = PairFromAngles(table.Place(), {angle(0), angle(1), angle(2), angle(3)});
  sample.value = {f, f, f};
  return sample;
}

}  // namespace

bool LooksLikeInPlane(std::string_view start) {
  if (LooksLikeUtf16(start)) return false;
  TextTable table("", std::string(start), TextTable::Cells::kFound);
  return FindNames(&table);
}

ScatteredBrdf ReadInPlane(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kFound);
  if (!FindNames(&table)) {
    Fail(path, ": no line that names the columns phi_in theta_in phi_out theta_out brdf");
  }
  ScatteredData data;
  while (table.Next()) {
    if (table.IsComment()) continue;
    table.RequireCells(table.names().size());
    if (IsComplete(table)) {
      data.samples.push_back(ParseRow(table));
    } else {
      ++data.left_out;
    }
  }
  data.kind = "in-plane measurements";
  data.channels = 1;
  data.isotropic = HaveOneIncidentAzimuth(data.samples);
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
