// planes.h: one number a pixel, and filters that are products of a row and a column.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace pbnbrdf {

struct Plane {
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}

  double* row(int y) { return &values[std::size_t(y) * std::size_t(width)]; }
  const double* row(int y) const { return &values[std::size_t(y) * std::size_t(width)]; }

  int width, height;
  std::vector<double> values;
};

// An odd number of weights, the middle one for the pixel itself.
using Kernel = std::vector<double>;

// exp(-x^2 / (2 sigma^2)) at x = -radius, ..., radius, scaled to the sum 1.
Kernel GaussianKernel(double sigma, int radius);

// sum_ij across[i] down[j] plane(x + i, y + j), i and j from the middles; beyond its edges the plane
// goes on as its edge pixels are.
Plane Filter(const Plane& plane, const Kernel& across, const Kernel& down);

// Calls function(y) for each row, several at a time.
void ForEachRow(int height, const std::function<void(int)>& function);

// The sum of row_sum(y) over the rows, the same bits whatever the number of threads.
double SumRows(int height, const std::function<double(int)>& row_sum);

}  // namespace pbnbrdf
