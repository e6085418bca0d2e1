#include "base/half.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

// By the format's definition, of a finite normal number.
double Value(int bits) {
  const int exponent = bits >> 10 & 31;
  const double size = std::ldexp(1024 + (bits & 1023), exponent - 25);
  return bits & 0x8000 ? -size : size;
}

// All positive normal numbers.
constexpr int kFirst = 0x0400, kEnd = 0x7c00;

TEST(Half, EveryNumberKeepsItsBits) {
  for (int sign : {0, 0x8000}) {
    for (int bits = kFirst; bits < kEnd; ++bits) {
      const double value = Value(bits | sign);
      ASSERT_EQ(NearestHalf(value), value);
      ASSERT_EQ(HalfBits(value), bits | sign);
    }
  }
  EXPECT_EQ(HalfBits(NearestHalf(0.0)), 0);
  EXPECT_EQ(Value(kEnd - 1), kMostHalf);
}

TEST(Half, OthersGoToTheNearestAndTiesToEven) {
  for (int bits = kFirst; bits + 1 < kEnd; ++bits) {
    const double low = Value(bits), high = Value(bits + 1), middle = 0.5 * (low + high);
    ASSERT_EQ(NearestHalf(middle), bits % 2 == 0 ? low : high);
    ASSERT_EQ(NearestHalf(std::nextafter(middle, 0.0)), low);
    ASSERT_EQ(NearestHalf(-std::nextafter(middle, 1e9)), -high);
  }
}

TEST(Half, SmallNumbersAreNormalOrZeroAndLargeOnesInfinite) {
  const double least = Value(kFirst);
  EXPECT_EQ(NearestHalf(0.51 * least), least);
  EXPECT_EQ(NearestHalf(-0.51 * least), -least);
  EXPECT_EQ(NearestHalf(0.49 * least), 0.0);
  EXPECT_EQ(NearestHalf(5e-324), 0.0);
  EXPECT_EQ(NearestHalf(65519.0), kMostHalf);
  EXPECT_EQ(NearestHalf(65520.0), INFINITY);
  EXPECT_EQ(NearestHalf(-1e300), -INFINITY);
}

}  // namespace
}  // namespace pbnbrdf
