#include "sources/warp_tables.h"

#include <algorithm>
#include <cmath>

namespace pbnbrdf {
namespace {

// The sum of blended elements of several arrays that lie `stride` apart.
template <typename T>
double Blend(const TableBlend& blend, const std::vector<T>& arrays, std::size_t stride,
             std::size_t index) {
  double sum = 0.0;
  for (int k = 0; k < blend.count; ++k) {
    sum += blend.weights[k] * static_cast<double>(arrays[blend.tables[k] * stride + index]);
  }
  return sum;
}

// The integral over the first part t of a cell of width 1 between values a and b.
double CellIntegral(double a, double b, double t) { return t * a + 0.5 * t * t * (b - a); }

// The t with that integral.
double InvertCell(double a, double b, double integral) {
  const double root = a + std::sqrt(std::max(0.0, a * a + 2.0 * integral * (b - a)));
  return root > 0.0 ? std::clamp(2.0 * integral / root, 0.0, 1.0) : 0.0;
}

// The last of the nodes but one whose cumulative(node) is at most `target`; non-decreasing.
template <typename Function>
std::size_t LastAtMost(std::size_t nodes, double target, Function cumulative) {
  std::size_t low = 0, high = nodes - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (cumulative(middle) <= target ? low : high) = middle;
  }
  return low;
}

}  // namespace

NodePosition PositionAt(double coordinate, std::size_t nodes) {
  const double x = coordinate > 0.0 ? std::min(coordinate, 1.0) : 0.0;
  const double at = x * static_cast<double>(nodes - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), nodes - 2);
  return {below, at - static_cast<double>(below)};
}

double Bilinear(const float* table, std::size_t rows, std::size_t columns, double x, double y) {
  const auto [column, a] = PositionAt(x, columns);
  const auto [row, b] = PositionAt(y, rows);
  const float* at = table + row * columns + column;
  return (1.0 - b) * ((1.0 - a) * at[0] + a * at[1]) +
         b * ((1.0 - a) * at[columns] + a * at[columns + 1]);
}

void TableBlend::Add(std::size_t table, double weight) {
  if (weight <= 0.0) return;
  tables[count] = table;
  weights[count] = weight;
  ++count;
}

WarpTables::WarpTables(std::vector<float> values, std::size_t rows, std::size_t columns)
    : rows_(rows), columns_(columns), values_(std::move(values)) {
  const std::size_t size = rows * columns, tables = values_.size() / size;
  row_sums_.resize(values_.size());
  sums_.resize(tables * rows);
  const double width = 1.0 / static_cast<double>(columns - 1);
  const double height = 1.0 / static_cast<double>(rows - 1);
  for (std::size_t table = 0; table < tables; ++table) {
    const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(table * size);
    const auto end = begin + static_cast<std::ptrdiff_t>(size);
    if (std::all_of(begin, end, [](float v) { return v == 0.0f; })) std::fill(begin, end, 1.0f);
    for (std::size_t row = 0; row < rows; ++row) {
      const float* value = &values_[table * size + row * columns];
      double* sum = &row_sums_[table * size + row * columns];
      for (std::size_t c = 1; c < columns; ++c) {
        sum[c] = sum[c - 1] + width * CellIntegral(value[c - 1], value[c], 1.0);
      }
      if (row == 0) continue;
      double* total = &sums_[table * rows + row];
      total[0] = total[-1] + height * 0.5 * (sum[columns - 1] + sum[-1]);
    }
  }
}

TableBlend WarpTables::Normalized(TableBlend blend) const {
  for (int k = 0; k < blend.count; ++k)
    blend.weights[k] /= sums_[(blend.tables[k] + 1) * rows_ - 1];
  return blend;
}

WarpTables WarpTables::Without(std::size_t theta, std::size_t period) const {
  const std::size_t count = values_.size() / (rows_ * columns_);
  return WarpTables(WithoutTables(values_, count, theta, period), rows_, columns_);
}

double WarpTables::Density(const TableBlend& blend, const SquarePoint& at) const {
  double density = 0.0;
  const TableBlend normalized = Normalized(blend);
  for (int k = 0; k < blend.count; ++k) {
    density += normalized.weights[k] * Bilinear(&values_[normalized.tables[k] * rows_ * columns_],
                                                rows_, columns_, at.x, at.y);
  }
  return density;
}

SquarePoint WarpTables::ToUniform(const TableBlend& blend, const SquarePoint& at) const {
  const TableBlend normalized = Normalized(blend);
  const std::size_t size = rows_ * columns_;
  const auto [row, b] = PositionAt(at.y, rows_);
  const auto [column, a] = PositionAt(at.x, columns_);
  // Of a whole row, and of its part up to the column.
  double whole[2], part[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t first = (row + k) * columns_, here = first + column;
    whole[k] = Blend(normalized, row_sums_, size, first + columns_ - 1);
    part[k] = Blend(normalized, row_sums_, size, here) +
              CellIntegral(Blend(normalized, values_, size, here),
                           Blend(normalized, values_, size, here + 1), a) /
                  static_cast<double>(columns_ - 1);
  }
  const double below = Blend(normalized, sums_, rows_, row) +
                       CellIntegral(whole[0], whole[1], b) / static_cast<double>(rows_ - 1);
  const double row_mass = (1.0 - b) * whole[0] + b * whole[1];
  const double left = (1.0 - b) * part[0] + b * part[1];
  return {row_mass > 0.0 ? std::clamp(left / row_mass, 0.0, 1.0) : at.x,
          std::clamp(below, 0.0, 1.0)};
}

SquarePoint WarpTables::FromUniform(const TableBlend& blend, const SquarePoint& uniform) const {
  const TableBlend normalized = Normalized(blend);
  const std::size_t size = rows_ * columns_;
  const auto sum = [&](std::size_t row) { return Blend(normalized, sums_, rows_, row); };
  const std::size_t row = LastAtMost(rows_, uniform.y, sum);
  const auto row_mass = [&](std::size_t r) {
    return Blend(normalized, row_sums_, size, (r + 1) * columns_ - 1);
  };
  const double b = InvertCell(row_mass(row), row_mass(row + 1),
                              (uniform.y - sum(row)) * static_cast<double>(rows_ - 1));
  // Row after row, in between two of them.
  const auto between = [&](const auto& arrays, std::size_t column) {
    return (1.0 - b) * Blend(normalized, arrays, size, row * columns_ + column) +
           b * Blend(normalized, arrays, size, (row + 1) * columns_ + column);
  };
  const auto part = [&](std::size_t column) { return between(row_sums_, column); };
  const double target = uniform.x * part(columns_ - 1);
  const std::size_t column = LastAtMost(columns_, target, part);
  const double a = InvertCell(between(values_, column), between(values_, column + 1),
                              (target - part(column)) * static_cast<double>(columns_ - 1));
  return {(static_cast<double>(column) + a) / static_cast<double>(columns_ - 1),
          (static_cast<double>(row) + b) / static_cast<double>(rows_ - 1)};
}

}  // namespace pbnbrdf
