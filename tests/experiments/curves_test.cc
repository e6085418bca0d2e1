#include "curves.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

const Curve kFalling = {{1.0, 0.4}, {2.0, 0.2}, {4.0, 0.1}};

TEST(ErrorAt, HoldsTheLastPointsErrorUntilTheNext) {
  EXPECT_EQ(ErrorAt(kFalling, 0.999), INFINITY);
  EXPECT_EQ(ErrorAt(kFalling, 1.0), 0.4);
  EXPECT_EQ(ErrorAt(kFalling, 3.999), 0.2);
  EXPECT_EQ(ErrorAt(kFalling, 100.0), 0.1);
  EXPECT_EQ(ErrorAt({}, 1.0), INFINITY);
}

TEST(TimeToError, IsThatOfTheFirstPointAtMostTheError) {
  EXPECT_EQ(TimeToError(kFalling, 0.4), 1.0);
  EXPECT_EQ(TimeToError(kFalling, 0.15), 4.0);
  EXPECT_EQ(TimeToError(kFalling, 0.09), INFINITY);
  const Curve rises_again = {{1.0, 0.1}, {2.0, 0.5}, {3.0, 0.1}};
  EXPECT_EQ(TimeToError(rises_again, 0.2), 1.0);
}

TEST(MedianCurve, OfOneCurveIsThatCurve) {
  const Curve median = MedianCurve({kFalling}, 5);
  ASSERT_EQ(median.size(), 5u);
  for (const CurvePoint& point : median) {
    EXPECT_EQ(point.error, ErrorAt(kFalling, point.seconds)) << point.seconds;
  }
  EXPECT_EQ(median.front().seconds, 1.0);
  EXPECT_EQ(median.back().seconds, 4.0);
  EXPECT_NEAR(median[1].seconds, std::sqrt(2.0), 1e-12);  // equal ratios
}

TEST(MedianCurve, BeginsWhereMostCurvesHaveBegun) {
  const Curve late = {{4.0, 0.3}}, later = {{16.0, 0.2}};
  const Curve median = MedianCurve({{{1.0, 0.4}}, late, later}, 5);  // at 1, 2, 4, 8, 16
  ASSERT_EQ(median.size(), 3u);
  EXPECT_NEAR(median[0].seconds, 4.0, 1e-12);
  EXPECT_EQ(median[0].error, 0.4);  // of 0.4, 0.3 and infinity
  EXPECT_EQ(median[2].error, 0.3);
}

TEST(MedianCurve, OfNoPointsIsEmpty) {
  EXPECT_TRUE(MedianCurve({}, 10).empty());
  EXPECT_TRUE(MedianCurve({{}, {}}, 10).empty());
}

}  // namespace
}  // namespace pbnbrdf
