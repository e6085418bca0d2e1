#include "pbnbrdf/network/encoding.h"

#include "brdf/direction_pairs.h"

namespace pbnbrdf {
namespace {

TEST(Encoding, ReciprocalOnesAreSoToTheBit) {
  for (const DirectionPair& pair : HardAndRandomPairs(100000, /*seed=*/1)) {
    for (Encoding encoding : {Encoding::kReciprocal, Encoding::kMultiscale, Encoding::kMerl}) {
      const auto there = Encode(encoding, pair), back = Encode(encoding, Swapped(pair));
      for (int i = 0; i < kEncodedSize; ++i) {
        ASSERT_EQ(there[i], back[i]) << NameOf(kEncodings, encoding) << " input " << i;
        ASSERT_TRUE(std::isfinite(there[i]));
      }
    }
  }
}

TEST(Encoding, CartesianIsNotReciprocal) {
  const DirectionPair pair = {FromSpherical(0.3, 0.2), FromSpherical(0.9, 2.0)};
  EXPECT_NE(Encode(Encoding::kCartesian, pair), Encode(Encoding::kCartesian, Swapped(pair)));
}

TEST(Encoding, IsWhatTheFormulasSay) {
  const double th = 0.5, td = 0.8, pd = 1.2;
  const DirectionPair pair = FromAngles({.theta_h = th, .theta_d = td, .phi_d = pd, .phi_h = 3.0});
  const double sd = std::sin(td);
  const std::array<double, 6> cartesian = {
      std::sin(th), 0.0, std::cos(th), sd * std::cos(pd), sd * std::sin(pd), std::cos(td)};
  const std::array<double, 6> reciprocal = {
      std::sin(th), 0.0, std::cos(th), sd * std::cos(2 * pd), sd * std::sin(2 * pd), std::cos(td)};
  const std::array<double, 6> multiscale = {std::sin(th),
                                            std::sqrt(2 * th / kPi),
                                            std::log(th + 0.001) / 3,
                                            sd * sd * std::cos(2 * pd),
                                            sd * sd * std::sin(2 * pd),
                                            std::cos(td)};
  const double row = 90 * std::sqrt(2 * th / kPi);  // 50.78: between rows 50 and 51 of a table
  std::array<double, 6> merl = multiscale;
  merl[0] = 4 * (row - 50) * (51 - row);
  for (int i = 0; i < kEncodedSize; ++i) {
    EXPECT_NEAR(Encode(Encoding::kCartesian, pair)[i], cartesian[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kReciprocal, pair)[i], reciprocal[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kMultiscale, pair)[i], multiscale[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kMerl, pair)[i], merl[i], 1e-12);
  }
}

}  // namespace
}  // namespace pbnbrdf
