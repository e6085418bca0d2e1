#include "sources/warp_tables.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kRows = 5, kColumns = 7, kTables = 3;

WarpTables RandomTables(unsigned seed) {
  std::vector<float> values;
  for (double v : RandomNumbers(kTables * kRows * kColumns, 0.0, 1.0, seed)) {
    values.push_back(v < 0.3 ? 0.0f : float(v));  // with holes
  }
  return {values, kRows, kColumns};
}

TableBlend BlendOf(std::initializer_list<std::pair<std::size_t, double>> parts) {
  TableBlend blend;
  for (const auto& [table, weight] : parts) blend.Add(table, weight);
  return blend;
}

const TableBlend kBlends[] = {BlendOf({{1, 1.0}}), BlendOf({{0, 0.3}, {2, 0.7}}),
                              BlendOf({{0, 0.2}, {1, 0.5}, {2, 0.3}})};

TEST(WarpTables, IntegrateToOne) {
  const WarpTables tables = RandomTables(1);
  constexpr int kSteps = 12 * 12;  // a multiple of both 4 and 6 cells: exact by the midpoint rule
  for (const TableBlend& blend : kBlends) {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        sum += tables.Density(blend, {(j + 0.5) / kSteps, (i + 0.5) / kSteps});
      }
    }
    EXPECT_NEAR(sum / (kSteps * kSteps), 1.0, 1e-9);
  }
}

TEST(WarpTables, TheMapsInvertEachOther) {
  const WarpTables tables = RandomTables(2);
  const std::vector<double> u = RandomNumbers(4000, 0.0, 1.0, 3);
  for (const TableBlend& blend : kBlends) {
    for (std::size_t n = 0; n + 1 < u.size(); n += 2) {
      const SquarePoint at = tables.FromUniform(blend, {u[n], u[n + 1]});
      const SquarePoint back = tables.ToUniform(blend, at);
      ASSERT_NEAR(back.x, u[n], 1e-7);
      ASSERT_NEAR(back.y, u[n + 1], 1e-7);
    }
  }
}

// The density is how much the map to the uniform one stretches areas.
TEST(WarpTables, TheMapHasTheDensity) {
  const WarpTables tables = RandomTables(4);
  const std::vector<double> u = RandomNumbers(400, 0.01, 0.99, 5);
  constexpr double kStep = 1e-6;
  for (const TableBlend& blend : kBlends) {
    for (std::size_t n = 0; n + 1 < u.size(); n += 2) {
      const auto map = [&](double x, double y) { return tables.ToUniform(blend, {x, y}); };
      const auto x0 = map(u[n] - kStep, u[n + 1]), x1 = map(u[n] + kStep, u[n + 1]);
      const auto y0 = map(u[n], u[n + 1] - kStep), y1 = map(u[n], u[n + 1] + kStep);
      const double area =
          ((x1.x - x0.x) * (y1.y - y0.y) - (x1.y - x0.y) * (y1.x - y0.x)) / (4 * kStep * kStep);
      ASSERT_NEAR(area, tables.Density(blend, {u[n], u[n + 1]}), 1e-4);
    }
  }
}

TEST(WarpTables, CornersMapToCorners) {
  const WarpTables tables({1, 2, 3, 4}, 2, 2);
  const TableBlend blend = BlendOf({{0, 1.0}});
  for (double x : {0.0, 1.0}) {
    for (double y : {0.0, 1.0}) {
      const SquarePoint there = tables.ToUniform(blend, {x, y});
      EXPECT_NEAR(there.x, x, 1e-12);
      EXPECT_NEAR(there.y, y, 1e-12);
      const SquarePoint back = tables.FromUniform(blend, {x, y});
      EXPECT_NEAR(back.x, x, 1e-12);
      EXPECT_NEAR(back.y, y, 1e-12);
    }
  }
}

TEST(WarpTables, NothingIsUniform) {
  const WarpTables tables(std::vector<float>(4, 0.0f), 2, 2);
  EXPECT_EQ(tables.Density(BlendOf({{0, 1.0}}), {0.3, 0.8}), 1.0);
}

TEST(WarpTables, CoordinatesStayWithinTheSquare) {
  for (double x : {-1.0, 0.0, 1.0, 2.0, std::nan("")}) {
    const auto [below, fraction] = PositionAt(x, 4);
    EXPECT_LE(below, 2u);
    EXPECT_TRUE(fraction >= 0.0 && fraction <= 1.0) << x;
  }
}

}  // namespace
}  // namespace pbnbrdf
