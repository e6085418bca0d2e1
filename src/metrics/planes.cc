#include "metrics/planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace pbnbrdf {
namespace {

Plane FilterAcross(const Plane& plane, const Kernel& kernel) {
  Plane filtered(plane.width, plane.height);
  const int radius = static_cast<int>(kernel.size() / 2);
  ForEachRow(plane.height, [&](int y) {
    const double* from = plane.row(y);
    double* to = filtered.row(y);
    for (int k = -radius; k <= radius; ++k) {
      const double weight = kernel[static_cast<std::size_t>(k + radius)];
      for (int x = 0; x < plane.width; ++x) {
        to[x] += weight * from[std::clamp(x + k, 0, plane.width - 1)];
      }
    }
  });
  return filtered;
}

Plane FilterDown(const Plane& plane, const Kernel& kernel) {
  Plane filtered(plane.width, plane.height);
  const int radius = static_cast<int>(kernel.size() / 2);
  ForEachRow(plane.height, [&](int y) {
    double* to = filtered.row(y);
    for (int k = -radius; k <= radius; ++k) {
      const double weight = kernel[static_cast<std::size_t>(k + radius)];
      const double* from = plane.row(std::clamp(y + k, 0, plane.height - 1));
      for (int x = 0; x < plane.width; ++x) to[x] += weight * from[x];
    }
  });
  return filtered;
}

}  // namespace

Kernel GaussianKernel(double sigma, int radius) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x)
    kernel.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

Plane Filter(const Plane& plane, const Kernel& across, const Kernel& down) {
  return FilterDown(FilterAcross(plane, across), down);
}

void ForEachRow(int height, const std::function<void(int)>& function) {
  ParallelFor(static_cast<std::size_t>(height),
              [&](std::size_t y) { function(static_cast<int>(y)); });
}

double SumRows(int height, const std::function<double(int)>& row_sum) {
  std::vector<double> sums(static_cast<std::size_t>(height));
  ForEachRow(height, [&](int y) { sums[static_cast<std::size_t>(y)] = row_sum(y); });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace pbnbrdf
