// point_tree.h: the nearest of many points, by a k-d tree.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace pbnbrdf {

class PointTree {
 public:
  static constexpr int kDimensions = 4;
  using Point = std::array<double, kDimensions>;

  struct Neighbor {
    double squared_distance;
    std::size_t index;  // in the points given
  };

  // Of finite points.
  explicit PointTree(std::vector<Point> points);

  // The `count` points nearest to `at`, or all if there are fewer, the nearest first; of equally near
  // ones those with a lower index.
  std::vector<Neighbor> Nearest(const Point& at, std::size_t count) const;

 private:
  struct Search;

  void Build(std::size_t begin, std::size_t end, int axis);
  void Visit(std::size_t begin, std::size_t end, int axis, Search* search) const;

  std::vector<Point> points_;       // in the order given
  std::vector<std::size_t> order_;  // the median of each range parts it, axis after axis
};

}  // namespace pbnbrdf
