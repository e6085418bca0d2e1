#include "results.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"
#include "pbnbrdf/base/error.h"
#include "table.h"

namespace pbnbrdf {
namespace {

using Values = std::map<std::pair<std::string, std::string>, double>;

void AddOnce(const std::string& name, std::vector<std::string>* names) {
  if (std::find(names->begin(), names->end(), name) == names->end()) names->push_back(name);
}

double ValueIn(const Values& values, const std::string& material, const std::string& method) {
  const auto found = values.find({material, method});
  return found == values.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

// Of the methods, those that have any value.
std::vector<std::string> MethodsIn(const Values& values, const std::vector<std::string>& methods) {
  std::vector<std::string> found;
  for (const std::string& method : methods) {
    const bool any = std::any_of(values.begin(), values.end(),
                                 [&](const auto& value) { return value.first.second == method; });
    if (any) found.push_back(method);
  }
  return found;
}

}  // namespace

Results::Results(std::string ours, std::vector<Quantity> quantities)
    : ours_(std::move(ours)), quantities_(std::move(quantities)) {}

void Results::Add(const std::string& quantity, const std::string& material,
                  const std::string& method, double value) {
  AddOnce(material, &materials_);
  AddOnce(method, &methods_);
  values_[quantity][{material, method}] = value;
}

double Results::Value(const std::string& quantity, const std::string& material,
                      const std::string& method) const {
  const auto found = values_.find(quantity);
  return found == values_.end() ? std::numeric_limits<double>::quiet_NaN()
                                : ValueIn(found->second, material, method);
}

std::string Results::TableOf(const Quantity& quantity, const Values& values) const {
  const std::vector<std::string> methods = MethodsIn(values, methods_);
  std::vector<std::string> columns = {"material"}, medians = {"**median**"};
  columns.insert(columns.end(), methods.begin(), methods.end());
  Table table(columns);
  for (const std::string& material : materials_) {
    std::vector<std::string> row = {material};
    bool any = false;
    for (const std::string& method : methods) {
      row.push_back(Significant(ValueIn(values, material, method), quantity.digits));
      any |= values.count({material, method}) != 0;
    }
    if (any) table.Add(row);
  }
  for (const std::string& method : methods) {
    std::vector<double> column;
    for (const std::string& material : materials_) {
      const double value = ValueIn(values, material, method);
      if (!std::isnan(value)) column.push_back(value);
    }
    medians.push_back(Significant(Median(column), quantity.digits));
  }
  table.Add(medians);
  return table.Markdown();
}

std::string Results::ComparisonsOf(const Quantity& quantity, const Values& values) const {
  const bool is_ratio = quantity.comparison == Comparison::kRatio;
  std::string lines;
  for (const std::string& method : MethodsIn(values, methods_)) {
    std::vector<double> all;
    for (const std::string& material : materials_) {
      const double a = ValueIn(values, material, ours_), b = ValueIn(values, material, method);
      const double compared = is_ratio ? a / b : a - b;
      if (method != ours_ && std::isfinite(compared)) all.push_back(compared);
    }
    if (all.empty()) continue;
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    lines += StrCat("- ", ours_, is_ratio ? " over " : " less ", method, ": median ",
                    Significant(Median(all), 3), ", from ", Significant(*least, 3), " to ",
                    Significant(*most, 3), " (", all.size(), " materials)\n");
  }
  return lines.empty() ? "" : "\n" + lines;
}

std::string Results::Markdown() const {
  std::string text;
  for (const Quantity& quantity : quantities_) {
    const auto found = values_.find(quantity.name);
    if (found == values_.end()) continue;
    text += StrCat(text.empty() ? "" : "\n", "### ", quantity.name, "\n\n",
                   TableOf(quantity, found->second));
    if (quantity.comparison != Comparison::kNone) text += ComparisonsOf(quantity, found->second);
  }
  return text;
}

}  // namespace pbnbrdf
