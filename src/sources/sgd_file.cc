#include "pbnbrdf/sources/sgd_file.h"

#include <algorithm>
#include <array>
#include <bitset>

#include "pbnbrdf/base/error.h"
#include "sources/text_table.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kNames =
    "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error";

SgdParameters ParseRow(const TextTable& table) {
  const SgdParameters m = {.rho_d = table.Number(3),
                           .rho_s = table.Number(4),
                           .alpha = table.Number(5),
                           .p = table.Number(6),
                           .f0 = table.Number(7),
                           .f1 = table.Number(8),
                           .kappa = table.Number(9),
                           .lambda = table.Number(10),
                           .c = table.Number(11),
                           .k = table.Number(12),
                           .theta_0 = table.Number(13)};
  if (!(m.alpha > 0.0)) Fail(table.Place(), ": alpha = ", m.alpha, "; must be > 0");
  return m;
}

TextTable OpenTable(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kCommas);
  if (!table.Next() || table.line() != kNames) {
    Fail(path, ": not a table of SGD parameters: the first line must be ", kNames);
  }
  table.NameColumns();
  return table;
}

}  // namespace

SgdBrdf ReadSgd(const std::string& path, const std::string& material) {
  TextTable table = OpenTable(path);
  std::array<SgdParameters, 3> channels;
  std::bitset<3> found;
  while (table.Next()) {
    const auto& cells = table.cells();
    if (cells[0] != material && (cells.size() < 2 || cells[1] != material)) continue;
    table.RequireCells(table.names().size());
    const std::size_t channel = std::string_view("rgb").find(cells[2]);
    if (cells[2].size() != 1 || channel == std::string_view::npos) {
      Fail(table.Place(), ": channel '", cells[2], "' is not one of r | g | b");
    }
    channels[channel] = ParseRow(table);
    found.set(channel);
  }
  if (found.none()) Fail(path, ": no material '", material, "' in it");
  if (!found.all()) Fail(path, ": material '", material, "' lacks a channel of r, g, b");
  return SgdBrdf(material, channels);
}

std::vector<std::string> SgdMaterialNames(const std::string& path) {
  TextTable table = OpenTable(path);
  std::vector<std::string> names;
  while (table.Next()) {
    const std::string name(table.cells()[0]);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

}  // namespace pbnbrdf
