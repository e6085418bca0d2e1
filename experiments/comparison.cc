#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kCurvePoints = 200;
constexpr char kPeer[] = "peer";

struct Column {
  const char* name;
  int digits;
  bool large_is_good;
};

constexpr Column kColumns[] = {{"seconds", 3, false},           {"error", 3, false},
                               {"peer, s", 3, false},           {"peer's error", 3, false},
                               {"s to that error", 3, false},   {"times as fast", 3, true},
                               {"error at peer's s", 3, false}, {"times as accurate", 3, true}};
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
  values.insert(values.end(), {peer->second.seconds, peer->second.error, versus.seconds_to_error,
                               versus.times_as_fast, versus.error_then, versus.times_as_accurate});
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

// The fits of a network and solver.
std::string Markdown(const std::vector<const FitRecord*>& fits, const PeerRecords& peers) {
  const std::size_t columns = peers.empty() ? kOwnColumns : std::size(kColumns);
  std::vector<std::string> names = {"material"};
  for (std::size_t c = 0; c < columns; ++c) names.push_back(kColumns[c].name);
  Table table(names);
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    std::vector<std::string> row = {name};
    for (std::size_t c = 0; c < columns; ++c) {
      row.push_back(Significant(values[c], kColumns[c].digits));
    }
    table.Add(row);
  };
  std::vector<std::vector<double>> of_fits, of_materials;
  std::vector<std::string> done;
  for (const FitRecord* first : fits) {
    if (std::find(done.begin(), done.end(), first->material) != done.end()) continue;
    done.push_back(first->material);
    std::vector<std::vector<double>> of_seeds;
    for (const FitRecord* fit : fits) {
      if (fit->material == first->material) of_seeds.push_back(Measures(*fit, peers));
    }
    of_fits.insert(of_fits.end(), of_seeds.begin(), of_seeds.end());
    of_materials.push_back(Medians(of_seeds));
    add(first->material, of_materials.back());
  }
  add("**median**", Medians(of_materials));
  add("**worst of all fits**", Worst(of_fits));
  return table.Markdown();
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
  Series line = MedianLine(kPeer, curves);
  line.dashed = true;
  return line;
}

}  // namespace

MaterialSource ParseMaterial(const std::string& text) {
  MaterialSource material;
  const std::size_t equals = text.find('=');
  const bool has_class = equals != std::string::npos && text.find_first_of("/:.") > equals;
  if (has_class) material.material_class = text.substr(0, equals);
  material.source = has_class ? text.substr(equals + 1) : text;
  if (material.source.empty()) Fail("material '", text, "': names no source");
  const std::string& source = material.source;
  const std::size_t hash = source.find('#');
  if (hash != std::string::npos) {
    material.name = source.substr(hash + 1);
  } else if (source.starts_with("builtin:")) {
    material.name = source.substr(source.find(':') + 1);
  } else {
    const std::size_t slash = source.rfind('/');
    const std::string file = slash == std::string::npos ? source : source.substr(slash + 1);
    material.name = file.substr(0, file.rfind('.'));
  }
  return material;
}

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
  std::string text;
  ForEachGroup(fits, [&](const std::string& hidden, const std::string& solver,
                         const std::vector<const FitRecord*>& group) {
    text += StrCat(text.empty() ? "" : "\n", "### ", solver, ", ", hidden, " hidden units\n\n",
                   Markdown(group, peers));
  });
  return text;
}

Figure ComparisonFigure(const std::vector<FitRecord>& fits, const PeerRecords& peers) {
  Figure figure;
  ForEachGroup(fits, [&](const std::string& hidden, const std::string& solver,
                         const std::vector<const FitRecord*>& group) {
    const std::string title = StrCat(hidden, " hidden units, median of all fits");
    if (figure.panels.empty() || figure.panels.back().title != title) {
      figure.panels.push_back({title, "Seconds", "Held-out error (mean |eq. 6|)", {}});
      if (!peers.empty()) figure.panels.back().series.push_back(PeerLine(peers));
    }
    std::vector<Curve> curves;
    for (const FitRecord* fit : group) curves.push_back(ErrorCurve(fit->trace));
    figure.panels.back().series.push_back(MedianLine(solver, curves));
  });
  return figure;
}

}  // namespace pbnbrdf
