#include "stability_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <sstream>

#include "base/median.h"
#include "pbnbrdf/base/error.h"
#include "table.h"

namespace pbnbrdf {
namespace {

// The runs of one level of a factor.
struct Tally {
  int runs = 0, ok = 0, errors = 0, non_finite = 0, crashes = 0;
  int diverged = 0, failed_factorizations = 0, rejected_steps = 0, restarts = 0;
  double worst_ratio = 0.0;
  GradientCheck gradient;

  void Add(const StabilityRecord& record, double ratio) {
    ++runs;
    ok += record.outcome == "ok";
    errors += record.outcome == "error";
    non_finite += record.outcome == "non-finite";
    crashes += record.outcome == "crash" || record.outcome == "timeout";
    diverged += record.termination == "diverged";
    failed_factorizations += record.failed_factorizations;
    rejected_steps += record.rejected_steps;
    restarts += record.restarts;
    if (ratio > worst_ratio) worst_ratio = ratio;
    gradient.Add(record.gradient);
  }

  std::vector<std::string> Cells(const std::string& name) const {
    std::ostringstream gradient_error;
    gradient_error.precision(2);
    gradient_error << gradient.worst_error;
    return {name,
            StrCat(runs),
            StrCat(ok),
            StrCat(errors),
            StrCat(non_finite),
            StrCat(crashes),
            StrCat(diverged),
            StrCat(failed_factorizations),
            StrCat(rejected_steps),
            StrCat(restarts),
            Significant(worst_ratio, 3),
            gradient_error.str(),
            StrCat(gradient.unresolved)};
  }
};

std::vector<std::string> TallyColumns(const std::string& factor) {
  return {factor,
          "runs",
          "ok",
          "errors",
          "non-finite",
          "crashes",
          "diverged",
          "failed factorisations",
          "rejected steps",
          "restarts",
          "worst error / median",
          "worst gradient error",
          "directions unresolved"};
}

std::size_t IndexOf(const std::vector<StabilityFactor>& factors, const std::string& name) {
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].name == name) return f;
  }
  Fail("no factor is named ", name);
}

std::string FactorTable(const StabilityFactor& factor, std::size_t index,
                        const std::vector<StabilityRecord>& records,
                        const std::vector<double>& ratios) {
  Tally all;
  std::map<std::string, Tally> tallies;
  for (std::size_t n = 0; n < records.size(); ++n) {
    tallies[records[n].levels[index]].Add(records[n], ratios[n]);
    all.Add(records[n], ratios[n]);
  }
  Table table(TallyColumns(factor.name));
  for (const std::string& level : factor.levels) {
    if (tallies.count(level) != 0) table.Add(tallies[level].Cells(level));
  }
  table.Add(all.Cells("all"));
  return table.Markdown();
}

std::string MessageTable(const std::vector<StabilityRecord>& records, const std::string& outcome) {
  std::map<std::string, std::pair<int, int>> kinds;  // how many, and the first of them
  for (const StabilityRecord& record : records) {
    if (record.outcome != outcome) continue;
    const std::string& text = outcome == "non-finite" ? record.non_finite : record.message;
    ++kinds.try_emplace(MessageKind(text), 0, record.run).first->second.first;
  }
  if (kinds.empty()) return "None.\n";
  Table table({"kind", "runs", "first run"});
  for (const auto& [kind, count] : kinds) {
    table.Add({kind, StrCat(count.first), StrCat(count.second)});
  }
  return table.Markdown();
}

}  // namespace

std::string MessageKind(const std::string& message) {
  static const std::regex number("[0-9]+(\\.[0-9]+)?(e[-+]?[0-9]+)?");
  return std::regex_replace(message, number, "#");
}

std::vector<double> ErrorRatios(const std::vector<StabilityFactor>& factors,
                                const std::vector<StabilityRecord>& records) {
  const std::size_t key[] = {IndexOf(factors, "material"), IndexOf(factors, "solver"),
                             IndexOf(factors, "terms")};
  const auto group_of = [&](const StabilityRecord& record) {
    std::string group;
    for (std::size_t f : key) group += record.levels[f] + "\n";
    return group;
  };
  std::map<std::string, std::vector<double>> errors;
  for (const StabilityRecord& record : records) {
    if (record.outcome == "ok") errors[group_of(record)].push_back(record.error);
  }
  std::vector<double> ratios;
  for (const StabilityRecord& record : records) {
    if (record.outcome != "ok") {
      ratios.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const double median = Median(errors[group_of(record)]);
    ratios.push_back(record.error / std::max(median, kMinMedian));
  }
  return ratios;
}

std::string StabilityMarkdown(const std::vector<StabilityFactor>& factors,
                              const std::vector<StabilityRecord>& records) {
  const std::vector<double> ratios = ErrorRatios(factors, records);
  std::string text;
  for (const char* name : {"stress", "material", "solver", "loss", "terms", "encoding", "precision",
                           "activation", "initialization"}) {
    const std::size_t f = IndexOf(factors, name);
    text += StrCat("### By ", name, "\n\n", FactorTable(factors[f], f, records, ratios), "\n");
  }
  text += "### Errors by kind\n\n" + MessageTable(records, "error");
  text += "\n### What wasn't finite\n\n" + MessageTable(records, "non-finite");
  text += "\n### Crashes\n\n" + MessageTable(records, "crash");
  text += "\n### Timeouts\n\n" + MessageTable(records, "timeout");
  return text;
}

}  // namespace pbnbrdf
