#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/median.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kCurvePoints = 200;
constexpr int kDigits = 3;

struct Column {
  const char* name;
  bool large_is_good, in_summary;
};

constexpr Column kColumns[] = {
    {"seconds", false, true},         {"error", false, true},
    {"peer, s", false, false},        {"peer's error", false, false},
    {"its own figure", false, false}, {"s to that error", false, false},
    {"times as fast", true, true},    {"error at peer's s", false, false},
    {"times as accurate", true, true}};
constexpr std::size_t kOwnColumns = 2;

// The values of one fit, in the order of kColumns; those of the peer unknown if there is none.
std::vector<double> Measures(const FitRecord& fit, const PeerRecords& peers) {
  std::vector<double> values = {fit.seconds, fit.error};
  const auto peer = peers.find(fit.material);
  if (peer == peers.end()) {
    values.resize(std::size(kColumns), kUnknown);
    return values;
  }
  const Versus versus = Compare(fit, peer->second);
  values.insert(values.end(), {peer->second.seconds, peer->second.error, peer->second.own_error,
                               versus.seconds_to_error, versus.times_as_fast, versus.error_then,
                               versus.times_as_accurate});
  return values;
}

// Column by column what `reduce(column, known values)` makes of the rows.
template <typename Reduce>
std::vector<double> ReduceColumns(const std::vector<std::vector<double>>& rows, Reduce reduce) {
  std::vector<double> reduced;
  for (std::size_t c = 0; c < std::size(kColumns); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) {
      if (!std::isnan(row[c])) values.push_back(row[c]);
    }
    reduced.push_back(values.empty() ? kUnknown : reduce(kColumns[c], values));
  }
  return reduced;
}

std::vector<double> Medians(const std::vector<std::vector<double>>& rows) {
  return ReduceColumns(rows, [](const Column&, const std::vector<double>& v) { return Median(v); });
}

std::vector<double> Worst(const std::vector<std::vector<double>>& rows) {
  return ReduceColumns(rows, [](const Column& column, const std::vector<double>& v) {
    return column.large_is_good ? *std::min_element(v.begin(), v.end())
                                : *std::max_element(v.begin(), v.end());
  });
}

// The fits of a network and solver: a row for each material, over all of them the median of these
// rows, and the worst fit's values.
struct Group {
  std::vector<std::string> materials;
  std::vector<std::vector<double>> rows;
  std::vector<double> median, worst;
};

Group MakeGroup(const std::vector<const FitRecord*>& fits, const PeerRecords& peers) {
  Group group;
  std::vector<std::vector<double>> of_fits;
  for (const FitRecord* first : fits) {
    if (std::find(group.materials.begin(), group.materials.end(), first->material) !=
        group.materials.end()) {
      continue;
    }
    std::vector<std::vector<double>> of_seeds;
    for (const FitRecord* fit : fits) {
      if (fit->material == first->material) of_seeds.push_back(Measures(*fit, peers));
    }
    of_fits.insert(of_fits.end(), of_seeds.begin(), of_seeds.end());
    group.materials.push_back(first->material);
    group.rows.push_back(Medians(of_seeds));
  }
  group.median = Medians(group.rows);
  group.worst = Worst(of_fits);
  return group;
}

std::string MaterialsMarkdown(const Group& group, std::size_t columns) {
  std::vector<std::string> names = {"material"};
  for (std::size_t c = 0; c < columns; ++c) names.push_back(kColumns[c].name);
  Table table(names);
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    std::vector<std::string> row = {name};
    for (std::size_t c = 0; c < columns; ++c) row.push_back(Significant(values[c], kDigits));
    table.Add(row);
  };
  for (std::size_t m = 0; m < group.rows.size(); ++m) add(group.materials[m], group.rows[m]);
  add("**median**", group.median);
  add("**worst of all fits**", group.worst);
  return table.Markdown();
}

Table SummaryTable(std::size_t columns) {
  std::vector<std::string> names = {"hidden units", "solver"};
  for (std::size_t c = 0; c < columns; ++c) {
    if (!kColumns[c].in_summary) continue;
    names.push_back(StrCat(kColumns[c].name, ", median"));
    names.push_back("worst");
  }
  return Table(names);
}

void AddSummary(const std::string& hidden, const std::string& solver, const Group& group,
                std::size_t columns, Table* table) {
  std::vector<std::string> row = {hidden, solver};
  for (std::size_t c = 0; c < columns; ++c) {
    if (!kColumns[c].in_summary) continue;
    row.push_back(Significant(group.median[c], kDigits));
    row.push_back(Significant(group.worst[c], kDigits));
  }
  table->Add(row);
}

// The values of `name(fit)`, each once, in the order of the fits.
template <typename Name>
std::vector<std::string> Distinct(const std::vector<FitRecord>& fits, Name name) {
  std::vector<std::string> names;
  for (const FitRecord& fit : fits) {
    if (std::find(names.begin(), names.end(), name(fit)) == names.end()) {
      names.push_back(name(fit));
    }
  }
  return names;
}

// Calls use(hidden, solver, fits) for each network and, of it, each solver.
template <typename Use>
void ForEachGroup(const std::vector<FitRecord>& fits, Use use) {
  for (const auto& hidden : Distinct(fits, [](const FitRecord& fit) { return fit.hidden; })) {
    for (const auto& solver : Distinct(fits, [](const FitRecord& fit) { return fit.solver; })) {
      std::vector<const FitRecord*> group;
      for (const FitRecord& fit : fits) {
        if (fit.hidden == hidden && fit.solver == solver) group.push_back(&fit);
      }
      if (!group.empty()) use(hidden, solver, group);
    }
  }
}

Series MedianLine(const std::string& label, const std::vector<Curve>& curves) {
  Series line;
  line.label = label;
  for (const CurvePoint& point : MedianCurve(curves, kCurvePoints)) {
    line.points.emplace_back(point.seconds, point.error);
  }
  return line;
}

Series PeerLine(const PeerRecords& peers) {
  std::vector<Curve> curves;
  for (const auto& [material, peer] : peers) curves.push_back(ErrorCurve(peer.trace));
  Series line = MedianLine(StrCat("peer, ", kPeerHidden), curves);
  line.dashed = true;
  return line;
}

}  // namespace

Curve ErrorCurve(const std::vector<FitProgress>& trace) {
  Curve curve;
  for (const FitProgress& progress : trace) {
    curve.push_back({progress.seconds, progress.heldout_error});
  }
  return curve;
}

Versus Compare(const FitRecord& fit, const PeerResult& peer) {
  const Curve curve = ErrorCurve(fit.trace);
  Versus versus;
  versus.seconds_to_error = TimeToError(curve, peer.error);
  versus.times_as_fast = peer.seconds / versus.seconds_to_error;
  versus.error_then = fit.seconds <= peer.seconds ? fit.error : ErrorAt(curve, peer.seconds);
  versus.times_as_accurate = peer.error / versus.error_then;
  return versus;
}

std::string ComparisonMarkdown(const std::vector<FitRecord>& fits, const PeerRecords& peers) {
  const std::size_t columns = peers.empty() ? kOwnColumns : std::size(kColumns);
  std::string text;
  Table summary = SummaryTable(columns);
  ForEachGroup(fits, [&](const std::string& hidden, const std::string& solver,
                         const std::vector<const FitRecord*>& of_group) {
    const Group group = MakeGroup(of_group, peers);
    text += StrCat("### ", solver, ", ", hidden, " hidden units\n\n",
                   MaterialsMarkdown(group, columns), "\n");
    AddSummary(hidden, solver, group, columns, &summary);
  });
  return StrCat(text, "### All materials\n\n", summary.Markdown());
}

Figure ComparisonFigure(const std::vector<FitRecord>& fits, const PeerRecords& peers) {
  Figure figure;
  ForEachGroup(fits, [&](const std::string& hidden, const std::string& solver,
                         const std::vector<const FitRecord*>& group) {
    const std::string title = StrCat(hidden, " hidden units, median of all fits");
    if (figure.panels.empty() || figure.panels.back().title != title) {
      figure.panels.push_back({title, "Seconds", "Held-out error (mean |eq. 6|)", {}});
    }
    std::vector<Curve> curves;
    for (const FitRecord* fit : group) curves.push_back(ErrorCurve(fit->trace));
    figure.panels.back().series.push_back(MedianLine(solver, curves));
  });
  for (Panel& panel : figure.panels) {
    if (!peers.empty()) panel.series.push_back(PeerLine(peers));
  }
  return figure;
}

}  // namespace pbnbrdf
