#include "ablation_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <string_view>

#include "base/median.h"
#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "table.h"

namespace pbnbrdf {
namespace {

using Records = std::vector<AblationRecord>;

// "Falls" and "rises" are changes by more than this part.
constexpr double kNotable = 0.1;

struct Measure {
  const char* name;
  double (*of)(const AblationRecord& record);
};

constexpr Measure kMeasures[] = {
    {"mean_abs_log_error", [](const AblationRecord& r) { return r.errors.mean_abs_log_error; }},
    {"chromaticity_error", [](const AblationRecord& r) { return r.errors.chromaticity_error; }},
    {"hrl", [](const AblationRecord& r) { return r.reciprocity.hrl; }},
    {"hcl", [](const AblationRecord& r) { return r.reciprocity.hcl; }},
    {"max_directional_albedo",
     [](const AblationRecord& r) { return r.energy.max_directional_albedo; }},
    {"eal", [](const AblationRecord& r) { return r.energy.eal; }},
    {"delta_e_mean", [](const AblationRecord& r) { return r.colors.delta_e_mean; }},
    {"delta_e_p95", [](const AblationRecord& r) { return r.colors.delta_e_p95; }},
    {"dark_hue_chroma_mean", [](const AblationRecord& r) { return r.colors.dark_hue_chroma_mean; }},
    {"dark_hue_chroma_p95", [](const AblationRecord& r) { return r.colors.dark_hue_chroma_p95; }},
    {"dark_samples",
     [](const AblationRecord& r) { return static_cast<double>(r.colors.dark_samples); }}};

double Value(const AblationRecord& record, std::string_view measure) {
  for (const Measure& known : kMeasures) {
    if (known.name == measure) return known.of(record);
  }
  Fail("no measure is named ", measure);
}

// A measure as a table shows it.
struct Column {
  const char* title;
  const char* measure;
  double scale = 1.0;
  int digits = 3;
};

// The values of `name(record)`, each once, in the order of the records.
template <typename Name>
std::vector<std::string> Distinct(const Records& records, Name name) {
  std::vector<std::string> names;
  for (const AblationRecord& record : records) {
    if (std::find(names.begin(), names.end(), name(record)) == names.end()) {
      names.push_back(name(record));
    }
  }
  return names;
}

template <typename Condition>
Records Select(const Records& records, Condition condition) {
  Records selected;
  std::copy_if(records.begin(), records.end(), std::back_inserter(selected), condition);
  return selected;
}

std::vector<std::string> SetUps(const Records& records) {
  return Distinct(records, [](const AblationRecord& r) { return r.set_up; });
}

Records OfSetUp(const Records& records, const std::string& set_up) {
  return Select(records, [&](const AblationRecord& r) { return r.set_up == set_up; });
}

std::vector<std::string> Materials(const Records& records) {
  return Distinct(records, [](const AblationRecord& r) { return r.material; });
}

// NaN if there is no record.
double MedianOfSeeds(const Records& records, const std::string& material,
                     std::string_view measure) {
  std::vector<double> values;
  for (const AblationRecord& r : records) {
    if (r.material == material) values.push_back(Value(r, measure));
  }
  return Median(std::move(values));
}

double MedianOfMaterials(const Records& records, std::string_view measure) {
  std::vector<double> values;
  for (const std::string& material : Materials(records)) {
    values.push_back(MedianOfSeeds(records, material, measure));
  }
  return Median(std::move(values));
}

double Worst(const Records& records, std::string_view measure) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const AblationRecord& r : records) worst = std::max(worst, Value(r, measure));
  return worst;
}

// Of all materials, those with a fit that makes energy.
std::string CountAmplifying(const Records& records) {
  const Records amplifying =
      Select(records, [](const AblationRecord& r) { return !r.energy.Conserved(); });
  return StrCat(Materials(amplifying).size(), " of ", Materials(records).size());
}

// A row for each set-up. count_title: of a last column with CountAmplifying; "": without it.
std::string SetUpTable(const Records& records, const std::vector<Column>& columns,
                       const std::string& count_title = "") {
  std::vector<std::string> titles = {"set-up"};
  for (const Column& column : columns) {
    titles.push_back(StrCat(column.title, ", median"));
    titles.push_back("worst");
  }
  if (!count_title.empty()) titles.push_back(count_title);
  Table table(titles);
  for (const std::string& set_up : SetUps(records)) {
    const Records of_set_up = OfSetUp(records, set_up);
    std::vector<std::string> row = {set_up};
    for (const auto& [title, measure, scale, digits] : columns) {
      row.push_back(Significant(scale * MedianOfMaterials(of_set_up, measure), digits));
      row.push_back(Significant(scale * Worst(of_set_up, measure), digits));
    }
    if (!count_title.empty()) row.push_back(CountAmplifying(of_set_up));
    table.Add(row);
  }
  return table.Markdown();
}

std::string ReciprocityMarkdown(const Records& records) {
  return StrCat("## Reciprocity (the paper's Table 1)\n\n",
                SetUpTable(records, {{"HRL x 10^3", "hrl", 1e3},
                                     {"HCL x 10^3", "hcl", 1e3},
                                     {"mean abs log error", "mean_abs_log_error"}}),
                R"(
For orientation, the paper's own figures (its Table 1: other data, the 100 MERL materials, and its
own fits):

| the paper's | HRL x 10^3 | HCL x 10^3 |
| ----------- | ---------: | ---------: |
| NBRDF       |      14729 |         52 |
| PBNBRDF     |         43 |          2 |

)");
}

std::string EnergyMarkdown(const Records& records) {
  return StrCat("## Energy (the paper's Table 2)\n\n",
                SetUpTable(records,
                           {{"largest directional albedo", "max_directional_albedo", 1.0, 8},
                            {"EAL, sr", "eal"},
                            {"mean abs log error", "mean_abs_log_error"}},
                           "materials with an albedo > 1 + 1e-6"),
                R"(
Materials are scaled by their albedos at up to 85 degrees, so that they may themselves exceed 1
beyond: there a fit can't both follow the material and conserve energy.

For orientation, the paper's own figures (its Table 2: other data, of renderings of RGL materials):

| the paper's | MAE x 10^3 | PSNR |  SSIM |
| ----------- | ---------: | ---: | ----: |
| NBRDF       |       6.42 | 47.4 | 0.978 |
| PBNBRDF     |       6.10 | 47.8 | 0.978 |

)");
}

// For each material that `counts` the error of the second set-up over that of the first.
template <typename Condition>
std::vector<double> Ratios(const Records& records, const std::string& from, const std::string& to,
                           Condition counts) {
  const Records before = OfSetUp(records, from), after = OfSetUp(records, to);
  std::vector<double> ratios;
  for (const std::string& material : Materials(after)) {
    if (!counts(material)) continue;
    ratios.push_back(MedianOfSeeds(after, material, "mean_abs_log_error") /
                     MedianOfSeeds(before, material, "mean_abs_log_error"));
  }
  return ratios;
}

// What the energy term costs those materials that conserve energy, and those that a fit can't follow.
std::string RatiosMarkdown(const Records& records, const std::string& from, const std::string& to) {
  const Records themselves = OfSetUp(records, kMaterialItself);
  const auto conserves = [&](const std::string& material) {
    return std::any_of(themselves.begin(), themselves.end(), [&](const AblationRecord& r) {
      return r.material == material && r.energy.Conserved();
    });
  };
  const auto row = [](const std::string& name, std::vector<double> ratios) {
    std::vector<std::string> cells = {name, StrCat(ratios.size()), "-", "-"};
    if (ratios.empty()) return cells;
    cells[3] = Significant(*std::max_element(ratios.begin(), ratios.end()), 4);
    cells[2] = Significant(Median(std::move(ratios)), 4);
    return cells;
  };
  Table table({"error with the energy term / without", "materials", "median", "worst"});
  table.Add(row("all", Ratios(records, from, to, [](const std::string&) { return true; })));
  table.Add(row("conserve energy themselves", Ratios(records, from, to, conserves)));
  table.Add(row("don't", Ratios(records, from, to, std::not_fn(conserves))));
  return table.Markdown();
}

std::string AllTermsMarkdown(const Records& records) {
  std::string text =
      StrCat("## All terms together (problems/pbnbrdf.flags)\n\n",
             SetUpTable(records,
                        {{"largest directional albedo", "max_directional_albedo", 1.0, 8},
                         {"HRL", "hrl"},
                         {"HCL", "hcl"},
                         {"mean abs log error", "mean_abs_log_error"}},
                        "materials with an albedo > 1 + 1e-6"));
  const std::vector<std::string> set_ups = SetUps(records);
  if (set_ups.size() < 3) return text;
  return text + "\n" + RatiosMarkdown(records, set_ups[1], set_ups[2]) + "\n";
}

Change& ChangeOfClass(const std::string& material_class, std::vector<Change>* changes) {
  for (Change& change : *changes) {
    if (change.material_class == material_class) return change;
  }
  changes->push_back({material_class, {}, {}, 0});
  return changes->back();
}

std::string Join(const std::vector<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) joined += (joined.empty() ? "" : ", ") + name;
  return joined.empty() ? "none" : joined;
}

// On which materials `to` helps and harms, in a sentence and by kind.
std::string ChangesMarkdown(const Records& records, const std::string& from,
                            const std::string& to) {
  Change all;
  Table kinds({"kind of material", "materials", "falls by > 10 %", "rises by > 10 %"});
  for (const Change& change : DarkColorChanges(records, from, to)) {
    all.materials += change.materials;
    all.falls.insert(all.falls.end(), change.falls.begin(), change.falls.end());
    all.rises.insert(all.rises.end(), change.rises.begin(), change.rises.end());
    kinds.Add({change.material_class.empty() ? "other" : change.material_class,
               StrCat(change.materials), StrCat(change.falls.size()), StrCat(change.rises.size())});
  }
  return StrCat("\n", to, " against ", from, ": dark hue/chroma p95 falls by more than 10 % on ",
                all.falls.size(), " of ", all.materials,
                " materials and rises by more than 10 % on ", all.rises.size(), ".\n\n",
                kinds.Markdown(), "\nIt falls on: ", Join(all.falls),
                ".\nIt rises on: ", Join(all.rises), ".\n");
}

std::string ChromaticityMarkdown(const Records& records) {
  std::string text = StrCat("## Chromaticity (the paper's Table 3)\n\n",
                            SetUpTable(records, {{"mean abs log error", "mean_abs_log_error"},
                                                 {"chromaticity error", "chromaticity_error"},
                                                 {"Delta E 2000 mean", "delta_e_mean"},
                                                 {"Delta E 2000 p95", "delta_e_p95"},
                                                 {"dark hue/chroma mean", "dark_hue_chroma_mean"},
                                                 {"dark hue/chroma p95", "dark_hue_chroma_p95"}}));
  text +=
      "\nDelta E 2000 is that of the lit colour, dark hue/chroma sqrt(da^2 + db^2) in CIELAB where "
      "the "
      "lit luminance is at most 0.1; p95: the 95th percentile of a fit's held-out samples.\n";
  const std::vector<std::string> set_ups = SetUps(records);
  for (std::size_t i = 1; i < set_ups.size(); ++i) {
    text += ChangesMarkdown(records, set_ups[0], set_ups[i]);
  }
  return text + R"(
For orientation, the paper's own figures (its Table 3: other data, of renderings of MERL materials,
all of its terms against NBRDF):

| the paper's |   MAE |  MSE | LPIPS x 10^3 | PSNR |  SSIM |
| ----------- | ----: | ---: | -----------: | ---: | ----: |
| NBRDF       | 0.805 | 2.45 |         9.11 | 32.9 | 0.988 |
| PBNBRDF     | 0.586 | 1.31 |         6.76 | 36.8 | 0.992 |

)";
}

}  // namespace

std::vector<std::string> AblationCsvHeader() {
  std::vector<std::string> columns = {"table", "set_up",     "material", "material_class",
                                      "seed",  "iterations", "seconds"};
  for (const Measure& measure : kMeasures) columns.push_back(measure.name);
  return columns;
}

std::vector<std::string> AblationCsvRow(const AblationRecord& record) {
  std::vector<std::string> cells = {
      StrCat(record.table),        record.set_up,       record.material,
      record.material_class,       StrCat(record.seed), StrCat(record.iterations),
      FormatNumber(record.seconds)};
  for (const Measure& measure : kMeasures) cells.push_back(FormatNumber(measure.of(record)));
  return cells;
}

bool IsFinite(const AblationRecord& record) {
  return std::all_of(std::begin(kMeasures), std::end(kMeasures),
                     [&](const Measure& measure) { return std::isfinite(measure.of(record)); });
}

std::string AblationMarkdown(const Records& records) {
  std::string (*const kSections[])(const Records&) = {ReciprocityMarkdown, EnergyMarkdown,
                                                      ChromaticityMarkdown, AllTermsMarkdown};
  std::string text;
  int table = 0;
  for (const auto& section : kSections) {
    ++table;
    const Records of_table =
        Select(records, [&](const AblationRecord& r) { return r.table == table; });
    if (!of_table.empty()) text += section(of_table);
  }
  return text;
}

std::vector<Change> DarkColorChanges(const Records& records, const std::string& from,
                                     const std::string& to) {
  const Records before = OfSetUp(records, from), after = OfSetUp(records, to);
  std::vector<Change> changes;
  for (const std::string& name : Materials(before)) {
    const AblationRecord& first = *std::find_if(
        before.begin(), before.end(), [&](const AblationRecord& r) { return r.material == name; });
    const double old_value = MedianOfSeeds(before, name, "dark_hue_chroma_p95");
    const double new_value = MedianOfSeeds(after, name, "dark_hue_chroma_p95");
    if (first.colors.dark_samples == 0 || std::isnan(new_value)) continue;
    Change& change = ChangeOfClass(first.material_class, &changes);
    ++change.materials;
    if (new_value < (1.0 - kNotable) * old_value) change.falls.push_back(name);
    if (new_value > (1.0 + kNotable) * old_value) change.rises.push_back(name);
  }
  return changes;
}

}  // namespace pbnbrdf
