// figure.h: line plots, drawn by gnuplot.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pbnbrdf {

struct Series {
  std::string label;                              // at the line's end
  std::vector<std::pair<double, double>> points;  // x > 0; y > 0 where the axis is logarithmic
  bool dashed = false;
  std::string group =
      "";  // lines of a group have the same colour in all panels; "": of equal labels
};

struct Panel {
  std::string title, x_label, y_label;
  std::vector<Series> series;  // those without points are left out
  bool log_y = true;           // x is always logarithmic
};

struct Figure {
  std::vector<Panel> panels;  // side by side, two in a row
};

// The commands that make gnuplot draw the figure, of at least one panel, to `svg`.
std::string GnuplotScript(const Figure& figure, const std::string& svg);

// Writes the script next to `svg`, its suffix replaced by .gnuplot, and runs it. Returns "" or, in
// a sentence, why there is no figure, as where gnuplot isn't installed.
std::string DrawFigure(const Figure& figure, const std::string& svg);

// Positions, moved up so that any two are `gap` apart, and down where that leads beyond 1.
std::vector<double> SpreadApart(const std::vector<double>& positions, double gap);

}  // namespace pbnbrdf
