#include "base/median.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pbnbrdf {
namespace {

TEST(Median, OfEvenAndOddNumbers) {
  EXPECT_EQ(Median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(Median({1.0, 1.0, INFINITY}), 1.0);
  EXPECT_TRUE(std::isnan(Median({})));
}

}  // namespace
}  // namespace pbnbrdf
