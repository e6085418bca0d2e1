#include "pbnbrdf/network/encoding.h"

#include "brdf/direction_pairs.h"
#include "pbnbrdf/models/builtin.h"

namespace pbnbrdf {
namespace {

TEST(Encoding, AllButCartesianAreReciprocalToTheBit) {
  for (const DirectionPair& pair : HardAndRandomPairs(100000, /*seed=*/1)) {
    for (const auto& [name, encoding] : kEncodings) {
      if (encoding == Encoding::kCartesian) continue;
      const auto there = Encode(encoding, pair), back = Encode(encoding, Swapped(pair));
      for (int i = 0; i < kEncodedSize; ++i) {
        ASSERT_EQ(there[i], back[i]) << name << " input " << i;
      }
    }
  }
}

TEST(Encoding, CartesianIsNotReciprocal) {
  const DirectionPair pair = {FromSpherical(0.3, 0.2), FromSpherical(0.9, 2.0)};
  EXPECT_NE(Encode(Encoding::kCartesian, pair), Encode(Encoding::kCartesian, Swapped(pair)));
}

TEST(Encoding, InputsAreFiniteAndOfModerateSize) {
  std::vector<DirectionPair> pairs = HardAndRandomPairs(10000, /*seed=*/2);
  for (std::size_t n = 0; n < pairs.size(); n += 3) pairs[n].wo.z *= -1.0;
  for (std::size_t n = 0; n < pairs.size(); n += 7) pairs[n].wi.z *= -1.0;
  const Vec3 w = FromSpherical(0.8, 2.0), up = {0.0, 0.0, 1.0};
  pairs.push_back({w, -1.0 * w});  // no half vector
  pairs.push_back({up, -1.0 * up});
  pairs.push_back({{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}});
  for (const DirectionPair& pair : pairs) {
    for (const auto& [name, encoding] : kEncodings) {
      for (double x : Encode(encoding, pair)) ASSERT_LE(std::abs(x), 2.5) << name;
    }
  }
}

TEST(Encoding, IsWhatTheFormulasSay) {
  const double th = 0.5, td = 0.8, pd = 1.2, ph = 3.0;
  const DirectionPair pair = FromAngles({.theta_h = th, .theta_d = td, .phi_d = pd, .phi_h = ph});
  const double sd = std::sin(td), root = std::sqrt(2 * th / kPi);
  const std::array<double, 6> cartesian = {
      std::sin(th), 0.0, std::cos(th), sd * std::cos(pd), sd * std::sin(pd), std::cos(td)};
  const std::array<double, 6> reciprocal = {
      std::sin(th), 0.0, std::cos(th), sd * std::cos(2 * pd), sd * std::sin(2 * pd), std::cos(td)};
  const std::array<double, 6> multiscale = {std::sin(th),
                                            root,
                                            std::log(th + 0.001) / 3,
                                            sd * sd * std::cos(2 * pd),
                                            sd * sd * std::sin(2 * pd),
                                            std::cos(td)};
  const double row = 90 * root;  // 50.78: between rows 50 and 51 of a table
  std::array<double, 6> merl = multiscale;
  merl[0] = 4 * (row - 50) * (51 - row);
  std::array<double, 6> bilateral = merl;
  bilateral[4] = std::sin(th);
  const double r = std::pow(2 * th / kPi, 0.75);
  const std::array<double, 6> anisotropic = {r * std::cos(ph),
                                             r * std::sin(ph),
                                             std::log(th + 0.001) / 3,
                                             sd * sd * std::cos(2 * (pd + ph)),
                                             sd * sd * std::sin(2 * (pd + ph)),
                                             std::cos(td)};
  for (int i = 0; i < kEncodedSize; ++i) {
    EXPECT_NEAR(Encode(Encoding::kCartesian, pair)[i], cartesian[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kReciprocal, pair)[i], reciprocal[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kMultiscale, pair)[i], multiscale[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kMerl, pair)[i], merl[i], 1e-12);
    EXPECT_NEAR(Encode(Encoding::kBilateral, pair)[i], bilateral[i], 1e-12);
    EXPECT_NEAR(Encode(Encoding::kAnisotropic, pair)[i], anisotropic[i], 1e-14);
  }
}

TEST(Encoding, IsotropicOnesDontDependOnPhiH) {
  // Rounding turns h by 1e-16 / sin theta_h, and RowBend grows by up to 360 times its argument.
  for (const DirectionPair& pair : RandomPairs(10000, /*seed=*/3)) {
    const auto turned = Turned(pair, 1.0);
    for (const auto& [name, encoding] : kEncodings) {
      const auto a = Encode(encoding, pair), b = Encode(encoding, turned);
      double difference = 0.0;
      for (int i = 0; i < kEncodedSize; ++i)
        difference = std::max(difference, std::abs(a[i] - b[i]));
      if (IsIsotropic(encoding)) {
        ASSERT_LT(difference, 1e-10) << name;
      } else {
        // |r e^(i phi_h) (1 - e^i)|, in the larger one of its components.
        ASSERT_GT(difference, 0.6 * std::hypot(a[0], a[1])) << name;
      }
    }
  }
}

TEST(Encoding, AnisotropicIsContinuousAtThePole) {
  // Exact mirror pairs, tilted by little in all directions: d's own frame spins with phi_h there.
  for (double theta : {0.0, 0.3, 1.2}) {
    const Vec3 wi = FromSpherical(theta, 0.7), wo = {-wi.x, -wi.y, wi.z};
    const auto at_pole = Encode(Encoding::kAnisotropic, {wi, wo});
    for (double phi = 0.0; phi < 6.3; phi += 0.1) {
      const double tilt = 1e-10;
      const Vec3 offset = {tilt * std::cos(phi), tilt * std::sin(phi), 0.0};
      const auto near = Encode(Encoding::kAnisotropic, {wi + offset, wo + offset});
      for (int i = 0; i < kEncodedSize; ++i) EXPECT_NEAR(near[i], at_pole[i], 1e-6) << i;
    }
  }
}

// A pair's mirror image in a vertical plane has phi_d of the other sign. In the planes of x and of
// y it has no rounding of its own, so that all bits must agree; where phi_d alone changes its sign,
// the rounding of the directions stands between the two.
TEST(Encoding, BilateralIsTheSameForMirrorImages) {
  const auto mirrored = [](const DirectionPair& p, double x, double y) {
    return DirectionPair{{x * p.wi.x, y * p.wi.y, p.wi.z}, {x * p.wo.x, y * p.wo.y, p.wo.z}};
  };
  for (const DirectionPair& pair : HardAndRandomPairs(100000, /*seed=*/4)) {
    const auto there = Encode(Encoding::kBilateral, pair);
    ASSERT_EQ(there, Encode(Encoding::kBilateral, mirrored(pair, 1.0, -1.0)));
    ASSERT_EQ(there, Encode(Encoding::kBilateral, mirrored(pair, -1.0, 1.0)));
  }
  for (const DirectionPair& pair : RandomPairs(10000, /*seed=*/5)) {
    RusinkiewiczAngles angles = ToAngles(pair);
    angles.phi_d = -angles.phi_d;
    const auto there = Encode(Encoding::kBilateral, pair);
    const auto image = Encode(Encoding::kBilateral, FromAngles(angles));
    for (int i = 0; i < kEncodedSize; ++i) ASSERT_NEAR(there[i], image[i], 1e-10) << i;
  }
}

TEST(Encoding, MerlTellsMirrorImagesApart) {
  const DirectionPair pair = {FromSpherical(0.3, 0.2), FromSpherical(0.9, 2.0)};
  const DirectionPair image = {FromSpherical(0.3, -0.2), FromSpherical(0.9, -2.0)};
  EXPECT_GT(std::abs(Encode(Encoding::kMerl, pair)[4] - Encode(Encoding::kMerl, image)[4]), 0.01);
}

TEST(Encoding, TheOneForAMaterialIsAsIsotropicAsIt) {
  EXPECT_EQ(EncodingFor(*MakeBuiltin("satin-gold")), Encoding::kMerl);
  EXPECT_EQ(EncodingFor(*MakeBuiltin("rolled-brass")), Encoding::kAnisotropic);
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    const std::unique_ptr<Brdf> brdf = material.make();
    EXPECT_EQ(IsIsotropic(EncodingFor(*brdf)), brdf->IsIsotropic()) << material.name;
  }
}

}  // namespace
}  // namespace pbnbrdf
