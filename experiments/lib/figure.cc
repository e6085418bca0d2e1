#include "figure.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "process.h"

namespace pbnbrdf {
namespace {

// Okabe and Ito's colours, which the colour-blind tell apart, without their yellow.
constexpr const char* kColors[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                   "#E69F00", "#000000", "#56B4E9"};
constexpr int kWidth = 720, kHeight = 440;  // of a panel, pixels
constexpr std::size_t kMaxMarkedPoints = 20;
constexpr double kLineHeight = 0.06;  // of a panel's graph

struct AxisRange {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool logarithmic = true;

  void Include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // A little more on both sides, so that no line lies on the frame.
  void Widen() {
    if (!logarithmic) {
      low = 0.0;
      high = high > 0.0 ? 1.08 * high : 1.0;
      return;
    }
    const double factor = std::pow(std::max(high / low, 1.5), 0.05);
    low /= factor;
    high *= factor;
  }
  double Fraction(double value) const {
    if (!logarithmic) return (value - low) / (high - low);
    return std::log(value / low) / std::log(high / low);
  }
};

std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

// "0.001", "20", "50k", "1M"
std::string TickLabel(double value) {
  if (value >= 1e6) return StrCat(1e-6 * value, "M");
  if (value >= 1e4) return StrCat(1e-3 * value, "k");
  return StrCat(value);
}

const std::string& ColourKey(const Series& series) {
  return series.group.empty() ? series.label : series.group;
}

// Powers of ten, and multiples of these where there would be few.
std::string LogTicks(const AxisRange& range) {
  const double ratio = range.high / range.low;
  std::vector<double> digits = {1.0};
  if (ratio < 1000.0) digits = {1.0, 3.0};
  if (ratio < 50.0) digits = {1.0, 2.0, 5.0};
  std::string ticks;
  for (int e = static_cast<int>(std::floor(std::log10(range.low))); std::pow(10.0, e) <= range.high;
       ++e) {
    for (double digit : digits) {
      const double value = digit * std::pow(10.0, e);
      if (value < range.low || value > range.high) continue;
      ticks += StrCat(ticks.empty() ? "" : ", ", Quoted(TickLabel(value)), " ", value);
    }
  }
  return "(" + ticks + ")";
}

class ScriptWriter {
 public:
  explicit ScriptWriter(const Figure& figure) {
    for (const Panel& panel : figure.panels) {
      for (const Series& series : panel.series) {
        colours_.emplace(ColourKey(series), kColors[colours_.size() % std::size(kColors)]);
        longest_label_ = std::max(longest_label_, series.label.size());
      }
    }
  }

  std::string Write(const Figure& figure, const std::string& svg) {
    const std::size_t columns = std::min<std::size_t>(2, figure.panels.size());
    const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
    out_ << "set terminal svg size " << columns * kWidth << "," << rows * kHeight
         << " noenhanced font 'Helvetica,15' background rgb 'white'\n"
         << "set output " << Quoted(svg) << "\n"
         << "unset key\nset border 3\nset tics nomirror\nset grid lt 1 lc rgb '#E4E4E4'\n"
         << "set rmargin " << longest_label_ + 3 << "\n";
    for (std::size_t p = 0; p < figure.panels.size(); ++p) WriteData(p, figure.panels[p]);
    out_ << "set multiplot layout " << rows << "," << columns << "\n";
    for (std::size_t p = 0; p < figure.panels.size(); ++p) WritePanel(p, figure.panels[p]);
    out_ << "unset multiplot\n";
    return out_.str();
  }

 private:
  static std::string DataName(std::size_t panel, std::size_t series) {
    return StrCat("$panel", panel, "_", series);
  }

  void WriteData(std::size_t p, const Panel& panel) {
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      out_ << DataName(p, s) << " << END\n";
      for (const auto& [x, y] : panel.series[s].points) out_ << x << " " << y << "\n";
      out_ << "END\n";
    }
  }

  void WritePanel(std::size_t p, const Panel& panel) {
    AxisRange x, y;
    y.logarithmic = panel.log_y;
    for (const Series& series : panel.series) {
      for (const auto& point : series.points) {
        x.Include(point.first);
        y.Include(point.second);
      }
    }
    if (!(x.low <= x.high)) return;
    x.Widen();
    y.Widen();
    out_ << "unset label\nunset arrow\nset title " << Quoted(panel.title) << "\nset xlabel "
         << Quoted(panel.x_label) << "\nset ylabel " << Quoted(panel.y_label)
         << "\nset logscale x\n"
         << (panel.log_y ? "set logscale y\n" : "unset logscale y\n") << "set xrange [" << x.low
         << ":" << x.high << "]\nset yrange [" << y.low << ":" << y.high << "]\nset xtics "
         << LogTicks(x) << "\nset ytics " << (panel.log_y ? LogTicks(y) : "autofreq") << "\n";
    WriteLabels(panel, y);
    WriteLines(p, panel);
  }

  // Each line's label stands to the right of the graph, at the height of the line's end as far as
  // other labels allow, and a dotted line leads there.
  void WriteLabels(const Panel& panel, const AxisRange& y) {
    std::vector<const Series*> shown;
    std::vector<double> heights;
    for (const Series& series : panel.series) {
      if (series.points.empty()) continue;
      shown.push_back(&series);
      heights.push_back(y.Fraction(series.points.back().second));
    }
    heights = SpreadApart(heights, kLineHeight);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto [end_x, end_y] = shown[i]->points.back();
      const std::string colour = StrCat(" rgb '", colours_.at(ColourKey(*shown[i])), "'");
      out_ << "set label " << Quoted(shown[i]->label) << " at graph 1.02, graph " << heights[i]
           << " tc" << colour << "\nset arrow from first " << end_x << ", first " << end_y
           << " to graph 1.015, graph " << heights[i] << " nohead dt 3 lw 1 lc" << colour << "\n";
    }
  }

  void WriteLines(std::size_t p, const Panel& panel) {
    out_ << "plot ";
    bool first = true;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
      const Series& series = panel.series[s];
      if (series.points.empty()) continue;
      const bool marked = series.points.size() <= kMaxMarkedPoints;
      out_ << (first ? "" : ", ") << DataName(p, s) << " with "
           << (marked ? "linespoints" : "lines") << " lw 2.5 dt " << (series.dashed ? 2 : 1)
           << (marked ? " pt 7 ps 0.5" : "") << " lc rgb '" << colours_.at(ColourKey(series))
           << "'";
      first = false;
    }
    out_ << "\n";
  }

  std::map<std::string, std::string> colours_;
  std::size_t longest_label_ = 0;
  std::ostringstream out_;
};

}  // namespace

std::vector<double> SpreadApart(const std::vector<double>& positions, double gap) {
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
  std::vector<double> spread = positions;
  for (std::size_t i = 1; i < order.size(); ++i) {
    spread[order[i]] = std::max(spread[order[i]], spread[order[i - 1]] + gap);
  }
  double most = std::max(1.0, (static_cast<double>(order.size()) - 1.0) * gap);
  for (std::size_t i = order.size(); i-- > 0; most = spread[order[i]] - gap) {
    spread[order[i]] = std::min(spread[order[i]], most);
  }
  return spread;
}

std::string GnuplotScript(const Figure& figure, const std::string& svg) {
  return ScriptWriter(figure).Write(figure, svg);
}

std::string DrawFigure(const Figure& figure, const std::string& svg) {
  if (figure.panels.empty()) return "no figure: there is nothing to draw";
  const std::string script = std::filesystem::path(svg).replace_extension(".gnuplot").string();
  WriteFile(script, GnuplotScript(figure, svg));
  const int status = RunProgram({"gnuplot", script}).status;
  if (status == 127) {
    return StrCat("no figure: gnuplot is not installed; where it is, gnuplot ", script,
                  " draws the figure");
  }
  if (status != 0) return StrCat("no figure: gnuplot ", script, " failed with status ", status);
  return "";
}

}  // namespace pbnbrdf
