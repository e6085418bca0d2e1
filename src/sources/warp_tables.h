// warp_tables.h: densities over the unit square, bilinear between the nodes of tables, blended from
// several tables, and the maps between them and the uniform density.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace pbnbrdf {

// Where a coordinate in [0, 1] lies on an axis of nodes from border to border.
struct NodePosition {
  std::size_t below;  // the node before, or the last but one
  double fraction;    // [0, 1] of the way to the next
};

// nodes >= 2. Coordinates beyond [0, 1], and NaN, are moved to a border.
NodePosition PositionAt(double coordinate, std::size_t nodes);

// The value at column x, row y of a table with rows x columns nodes, row after row.
double Bilinear(const float* table, std::size_t rows, std::size_t columns, double x, double y);

// Up to four tables of a stack, with weights that sum to 1.
struct TableBlend {
  int count = 0;
  std::array<std::size_t, 4> tables;
  std::array<double, 4> weights;

  void Add(std::size_t table, double weight);
};

// What is left of a stack of `count` tables without the theta-th of each `period` ones.
template <typename T>
std::vector<T> WithoutTables(const std::vector<T>& stack, std::size_t count, std::size_t theta,
                             std::size_t period) {
  const std::size_t size = stack.size() / count;
  std::vector<T> kept;
  for (std::size_t i = 0; i < stack.size(); ++i) {
    if (i / size % period != theta) kept.push_back(stack[i]);
  }
  return kept;
}

struct SquarePoint {
  double x, y;  // column and row, [0, 1]
};

class WarpTables {
 public:
  // values: >= 0, [tables][rows][columns], rows and columns >= 2. Each table is scaled so that its
  // interpolant integrates to 1; one that is 0 everywhere becomes uniform.
  WarpTables(std::vector<float> values, std::size_t rows, std::size_t columns);

  // The tables without one in each `period`: the theta-th, theta + period-th, ...
  WarpTables Without(std::size_t theta, std::size_t period) const;

  // The blend's density.
  double Density(const TableBlend& blend, const SquarePoint& at) const;

  // y: the mass of the rows up to at.y; x: that of the columns up to at.x, as a part of row at.y.
  // Uniform in the square if `at` has the density.
  SquarePoint ToUniform(const TableBlend& blend, const SquarePoint& at) const;

  // Its inverse.
  SquarePoint FromUniform(const TableBlend& blend, const SquarePoint& uniform) const;

 private:
  // Weights that bring each table to an integral of 1, too.
  TableBlend Normalized(TableBlend blend) const;

  std::size_t rows_, columns_;
  std::vector<float> values_;
  std::vector<double> row_sums_;  // [tables][rows][columns]: the integral along the row up to here
  std::vector<double> sums_;      // [tables][rows]: of the rows up to here
};

}  // namespace pbnbrdf
