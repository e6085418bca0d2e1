#include "brdf/point_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pbnbrdf {
namespace {

bool IsNearer(const PointTree::Neighbor& a, const PointTree::Neighbor& b) {
  return std::pair(a.squared_distance, a.index) < std::pair(b.squared_distance, b.index);
}

}  // namespace

struct PointTree::Search {
  Point at;
  std::size_t count;
  std::vector<Neighbor> found = {};  // so far, the nearest first
  // From `at` to the part of space that is visited, along each axis, and its square.
  Point gap = {};
  double squared_gap = 0.0;

  void Offer(const Neighbor& neighbor) {
    if (found.size() == count) {
      if (!IsNearer(neighbor, found.back())) return;
      found.pop_back();
    }
    found.insert(std::upper_bound(found.begin(), found.end(), neighbor, IsNearer), neighbor);
  }

  // Whether a point at that distance could be among the nearest.
  bool Wants(double squared_distance) const {
    constexpr double kRounding = 1e-12;
    return found.size() < count ||
           squared_distance * (1.0 - kRounding) <= found.back().squared_distance;
  }
};

PointTree::PointTree(const std::vector<Point>& points) : order_(points.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  Build(points, 0, order_.size(), 0);
  for (const std::size_t index : order_) points_.push_back(points[index]);
}

void PointTree::Build(const std::vector<Point>& points, std::size_t begin, std::size_t end,
                      int axis) {
  if (end - begin <= kLeaf) return;
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
  });
  Build(points, begin, middle, (axis + 1) % kDimensions);
  Build(points, middle + 1, end, (axis + 1) % kDimensions);
}

void PointTree::Offer(std::size_t place, Search* search) const {
  double squared_distance = 0.0;
  for (int k = 0; k < kDimensions; ++k) {
    const double difference = points_[place][k] - search->at[k];
    squared_distance += difference * difference;
  }
  search->Offer({squared_distance, order_[place]});
}

void PointTree::Visit(std::size_t begin, std::size_t end, int axis, Search* search) const {
  if (end - begin <= kLeaf) {
    for (std::size_t place = begin; place < end; ++place) Offer(place, search);
    return;
  }
  const std::size_t middle = (begin + end) / 2;
  Offer(middle, search);
  const double across = search->at[axis] - points_[middle][axis];
  const int next = (axis + 1) % kDimensions;
  const auto visit = [&](bool below) {
    if (below)
      Visit(begin, middle, next, search);
    else
      Visit(middle + 1, end, next, search);
  };
  visit(across < 0.0);
  const double gap = search->gap[axis], squared_gap = search->squared_gap;
  const double farther = squared_gap - gap * gap + across * across;
  if (!search->Wants(farther)) return;
  search->gap[axis] = across;
  search->squared_gap = farther;
  visit(!(across < 0.0));
  search->gap[axis] = gap;
  search->squared_gap = squared_gap;
}

std::vector<PointTree::Neighbor> PointTree::Nearest(const Point& at, std::size_t count) const {
  Search search = {.at = at, .count = std::min(count, points_.size())};
  search.found.reserve(search.count);
  if (search.count > 0) Visit(0, points_.size(), 0, &search);
  return search.found;
}

}  // namespace pbnbrdf
