#include "brdf/point_tree.h"

#include <algorithm>

#include "test_util.h"

namespace pbnbrdf {
namespace {

// The plain way: all distances, sorted.
std::vector<std::size_t> NearestByForce(const std::vector<PointTree::Point>& points,
                                        const PointTree::Point& at, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> all;
  for (std::size_t n = 0; n < points.size(); ++n) {
    double sum = 0.0;
    for (int k = 0; k < PointTree::kDimensions; ++k) {
      sum += (points[n][k] - at[k]) * (points[n][k] - at[k]);
    }
    all.emplace_back(sum, n);
  }
  std::sort(all.begin(), all.end());
  std::vector<std::size_t> indices;
  for (std::size_t n = 0; n < std::min(count, all.size()); ++n) indices.push_back(all[n].second);
  return indices;
}

std::vector<std::size_t> Indices(const std::vector<PointTree::Neighbor>& neighbors) {
  std::vector<std::size_t> indices;
  for (const PointTree::Neighbor& neighbor : neighbors) indices.push_back(neighbor.index);
  return indices;
}

std::vector<PointTree::Point> Points(std::size_t count, double step, unsigned seed) {
  const std::vector<double> x = RandomNumbers(4 * count, -1.0, 1.0, seed);
  std::vector<PointTree::Point> points(count);
  for (std::size_t n = 0; n < count; ++n) {
    for (int k = 0; k < 4; ++k) points[n][k] = step * std::round(x[4 * n + k] / step);
  }
  return points;
}

// On coarse lattices many points are equally near, and several at one place.
TEST(PointTree, FindsWhatComparingAllFinds) {
  for (double step : {1e-9, 0.1, 0.5, 2.0}) {
    for (std::size_t count : {1, 2, 3, 10, 500}) {
      const std::vector<PointTree::Point> points = Points(count, step, 1);
      const PointTree tree(points);
      for (const PointTree::Point& at : Points(50, step / 2, 2)) {
        for (std::size_t wanted : {1, 9, 20}) {
          ASSERT_EQ(Indices(tree.Nearest(at, wanted)), NearestByForce(points, at, wanted))
              << step << " " << count << " " << wanted;
        }
      }
    }
  }
}

TEST(PointTree, OfNothingThereIsNothingNear) {
  EXPECT_TRUE(PointTree({}).Nearest({}, 3).empty());
  EXPECT_TRUE(PointTree(Points(5, 0.1, 1)).Nearest({}, 0).empty());
}

}  // namespace
}  // namespace pbnbrdf
