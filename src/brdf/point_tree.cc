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

// The nearest so far, as a heap with the farthest on top.
struct PointTree::Search {
  Point at;
  std::size_t count;
  std::vector<Neighbor> found;

  void Offer(const Neighbor& neighbor) {
    if (found.size() == count) {
      if (!IsNearer(neighbor, found.front())) return;
      std::pop_heap(found.begin(), found.end(), IsNearer);
      found.pop_back();
    }
    found.push_back(neighbor);
    std::push_heap(found.begin(), found.end(), IsNearer);
  }

  // Whether a point at that distance could be among the nearest.
  bool Wants(double squared_distance) const {
    return found.size() < count || squared_distance <= found.front().squared_distance;
  }
};

PointTree::PointTree(std::vector<Point> points)
    : points_(std::move(points)), order_(points_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  Build(0, order_.size(), 0);
}

void PointTree::Build(std::size_t begin, std::size_t end, int axis) {
  if (end - begin < 2) return;
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
    return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b);
  });
  Build(begin, middle, (axis + 1) % kDimensions);
  Build(middle + 1, end, (axis + 1) % kDimensions);
}

void PointTree::Visit(std::size_t begin, std::size_t end, int axis, Search* search) const {
  if (begin == end) return;
  const std::size_t middle = (begin + end) / 2, index = order_[middle];
  const Point& point = points_[index];
  double squared_distance = 0.0;
  for (int k = 0; k < kDimensions; ++k) {
    squared_distance += (point[k] - search->at[k]) * (point[k] - search->at[k]);
  }
  search->Offer({squared_distance, index});
  const double across = search->at[axis] - point[axis];
  const int next = (axis + 1) % kDimensions;
  const bool is_below = across < 0.0;
  if (is_below)
    Visit(begin, middle, next, search);
  else
    Visit(middle + 1, end, next, search);
  if (!search->Wants(across * across)) return;
  if (is_below)
    Visit(middle + 1, end, next, search);
  else
    Visit(begin, middle, next, search);
}

std::vector<PointTree::Neighbor> PointTree::Nearest(const Point& at, std::size_t count) const {
  Search search = {at, std::min(count, points_.size()), {}};
  search.found.reserve(search.count);
  if (search.count > 0) Visit(0, order_.size(), 0, &search);
  std::sort_heap(search.found.begin(), search.found.end(), IsNearer);
  return search.found;
}

}  // namespace pbnbrdf
