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
  explicit PointTree(const std::vector<Point>& points);

  // The `count` points nearest to `at`, or all if there are fewer, the nearest first; of equally near
  // ones those with a lower index.
  std::vector<Neighbor> Nearest(const Point& at, std::size_t count) const;

 private:
  struct Search;

  void Build(const std::vector<Point>& points, std::size_t begin, std::size_t end, int axis);
  void Visit(std::size_t begin, std::size_t end, int axis, Search* search) const;
  void Offer(std::size_t place, Search* search) const;

  static constexpr std::size_t kLeaf = 8;  // points at most that aren't parted

  // The median of each range of places parts it, axis after axis.
  std::vector<Point> points_;
  std::vector<std::size_t> order_;  // which of the points given each is
};

}  // namespace pbnbrdf
