#include "paper_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "base/median.h"
#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "table.h"

namespace pbnbrdf {
namespace {

struct Column {
  std::string name;
  std::function<double(const PaperRecord&)> value;
  bool larger_is_better = false;
  int digits = 3;
  bool is_compared = true;
};

struct PaperTable {
  std::string title, about;
  std::vector<Column> columns;
  bool only_low_dissipation = false;
  std::string printed;  // what the paper has, of its own materials and pictures
};

double Hrl(const PaperRecord& r) { return 1e3 * r.reciprocity.hrl; }
double Hcl(const PaperRecord& r) { return 1e3 * r.reciprocity.hcl; }
double Eal(const PaperRecord& r) { return r.energy.eal; }
double Albedo(const PaperRecord& r) { return r.energy.max_directional_albedo; }

std::vector<PaperTable> Tables() {
  const Column mae = {"MAE x 1000", [](const PaperRecord& r) { return 1e3 * r.picture.mae; }};
  const Column mse = {"MSE x 1000", [](const PaperRecord& r) { return 1e3 * r.picture.mse; }};
  const Column lpips = {"LPIPS x 1000", [](const PaperRecord& r) { return 1e3 * r.lpips; }};
  const Column psnr = {"PSNR, dB", [](const PaperRecord& r) { return r.picture.psnr; }, true};
  const Column ssim = {"SSIM", [](const PaperRecord& r) { return r.picture.ssim; }, true, 5};
  const Column flip = {"FLIP", [](const PaperRecord& r) { return r.picture.flip; }};
  const Column error = {"log error", [](const PaperRecord& r) { return r.log_error; }};
  return {
      {"Table 1: reciprocity",
       "HRL and HCL (eqs. 8 and 9) of all materials.",
       {{"HRL x 1000", Hrl}, {"HCL x 1000", Hcl}},
       false,
       "NBRDF HRL x 1000 14729, HCL x 1000 52; PBNBRDF 43, 2"},
      {"Table 2: energy",
       "Pictures of the materials that reflect nearly all light, and the energy that fits make.",
       {mae, psnr, ssim, {"EAL, sr", Eal}, {"largest albedo", Albedo, false, 5, false}},
       true,
       "NBRDF MAE x 1000 6.42, PSNR 47.4, SSIM 0.978; PBNBRDF 6.10, 47.8, 0.978"},
      {"Table 3: colour",
       "Pictures of all materials.",
       {mae, mse, lpips, psnr, ssim, flip, error},
       false,
       "NBRDF MAE 0.805, MSE 2.45, LPIPS x 1000 9.11, PSNR 32.9, SSIM 0.988; PBNBRDF 0.586, 1.31, "
       "6.76, 36.8, "
       "0.992"}};
}

// What methods have of one column, by method and material.
using Values = std::map<std::string, std::map<std::string, double>>;

bool IsBetter(double a, double b, const Column& column) {
  return column.larger_is_better ? a > b : a < b;
}

std::string Text(double value, int digits) {
  return value == 0.0 ? "0" : Significant(value, digits);
}

std::string Cell(const std::map<std::string, double>& of_materials, const Column& column) {
  std::vector<double> values;
  for (const auto& [material, value] : of_materials) {
    if (!std::isnan(value)) values.push_back(value);
  }
  if (values.empty()) return "-";
  const double worst = column.larger_is_better ? *std::min_element(values.begin(), values.end())
                                               : *std::max_element(values.begin(), values.end());
  return StrCat(Text(Median(values), column.digits), " (", Text(worst, column.digits), ")");
}

// Ours beside another method's, of one column, over the materials that both have.
struct Duel {
  std::vector<double> ours, other;
  std::size_t better = 0, equal = 0;
  std::vector<std::string> worse;  // the materials

  Duel(const Column& column, const Values& values, const std::string& method) {
    const auto of_us = values.find(kOurs), of_them = values.find(method);
    if (of_us == values.end() || of_them == values.end()) return;
    for (const auto& [material, theirs] : of_them->second) {
      const auto at = of_us->second.find(material);
      if (at == of_us->second.end() || std::isnan(theirs) || std::isnan(at->second)) continue;
      ours.push_back(at->second);
      other.push_back(theirs);
      better += IsBetter(at->second, theirs, column);
      equal += at->second == theirs;
      if (IsBetter(theirs, at->second, column)) worse.push_back(material);
    }
  }
};

// A row for each other method: the two medians, and on how many materials ours is better. Below, where it is worse.
std::string ComparisonsOf(const std::vector<Column>& columns, const std::vector<Values>& values,
                          const std::vector<std::string>& methods) {
  std::vector<std::string> heads = {"ours and ..."};
  for (const Column& column : columns) {
    if (column.is_compared) heads.push_back(column.name);
  }
  Table table(heads);
  std::string losses;
  for (const std::string& method : methods) {
    if (method == kOurs || method == kItself) continue;
    if (Duel(columns[0], values[0], method).ours.empty()) continue;
    std::vector<std::string> row = {method};
    std::map<std::string, std::vector<std::string>> worse;  // columns, by material
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!columns[k].is_compared) continue;
      const Duel duel(columns[k], values[k], method);
      row.push_back(StrCat(Text(Median(duel.ours), columns[k].digits), " and ",
                           Text(Median(duel.other), columns[k].digits), "; ", duel.better, " of ",
                           duel.ours.size(),
                           duel.equal > 0 ? StrCat(", ", duel.equal, " equal") : ""));
      for (const std::string& material : duel.worse) worse[material].push_back(columns[k].name);
    }
    table.Add(row);
    std::vector<std::string> texts;
    for (const auto& [material, names] : worse)
      texts.push_back(StrCat(material, " (", Join(names, "; "), ")"));
    if (!texts.empty()) losses += StrCat("- ", method, " is ahead on ", Join(texts, ", "), "\n");
  }
  return table.Markdown() +
         (losses.empty() ? "" : "\nWhere ours isn't the best of two:\n\n" + losses);
}

bool HasValues(const std::vector<Values>& columns, const std::string& method) {
  return std::any_of(columns.begin(), columns.end(), [&](const Values& values) {
    const auto found = values.find(method);
    return found != values.end() &&
           std::any_of(found->second.begin(), found->second.end(),
                       [](const auto& of_material) { return !std::isnan(of_material.second); });
  });
}

std::string MarkdownOf(PaperTable table, const std::vector<PaperRecord>& records) {
  std::erase_if(table.columns, [&](const Column& column) {  // what nobody measured
    return std::all_of(records.begin(), records.end(),
                       [&](const PaperRecord& record) { return std::isnan(column.value(record)); });
  });
  std::vector<std::string> methods, heads = {"method", "materials"};
  std::vector<Values> values(table.columns.size());
  std::map<std::string, std::size_t> counts;
  for (const PaperRecord& record : records) {
    if (table.only_low_dissipation && !record.low_dissipation) continue;
    if (counts[record.method]++ == 0) methods.push_back(record.method);
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      values[k][record.method][record.material] = table.columns[k].value(record);
    }
  }
  std::erase_if(methods, [&](const std::string& method) { return !HasValues(values, method); });
  if (methods.empty()) return "";
  for (const Column& column : table.columns) heads.push_back(column.name);
  Table rows(heads);
  for (const std::string& method : methods) {
    std::vector<std::string> row = {method, StrCat(counts[method])};
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      row.push_back(Cell(values[k][method], table.columns[k]));
    }
    rows.Add(row);
  }
  std::string text =
      StrCat("### ", table.title, "\n\n", table.about, " Median (worst) over materials.\n\n",
             rows.Markdown(),
             "\nPrinted in the paper, of other materials and pictures: ", table.printed, ".\n\n");
  text +=
      "Medians of ours and of another method on the materials that both have, and on how many ours "
      "is better:\n\n";
  return text + ComparisonsOf(table.columns, values, methods) + "\n";
}

}  // namespace

std::string PaperMarkdown(const std::vector<PaperRecord>& records) {
  std::string text = "## The paper's tables\n\n";
  for (const PaperTable& table : Tables()) text += MarkdownOf(table, records);
  return text;
}

std::string PaperCsv(const std::vector<PaperRecord>& records) {
  std::string csv =
      "material,method,low_dissipation,log_error,hrl,hcl,eal,largest_albedo,mae,mse,psnr,ssim,"
      "flip,lpips\n";
  for (const PaperRecord& r : records) {
    csv += CsvLine({r.material, r.method, r.low_dissipation ? "1" : "0", FormatNumber(r.log_error),
                    FormatNumber(r.reciprocity.hrl), FormatNumber(r.reciprocity.hcl),
                    FormatNumber(Eal(r)), FormatNumber(Albedo(r)), FormatNumber(r.picture.mae),
                    FormatNumber(r.picture.mse), FormatNumber(r.picture.psnr),
                    FormatNumber(r.picture.ssim), FormatNumber(r.picture.flip),
                    FormatNumber(r.lpips)});
  }
  return csv;
}

}  // namespace pbnbrdf
