#include "pbnbrdf/network/encoding.h"

#include <ceres/jet.h>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/models/builtin.h"

namespace pbnbrdf {
namespace {

TEST(Encoding, ReciprocalOnesAreSoToTheBit) {
  for (const DirectionPair& pair : HardAndRandomPairs(100000, /*seed=*/1)) {
    for (const auto& [name, encoding] : kEncodings) {
      if (!IsReciprocal(encoding)) continue;
      const auto there = Encode(encoding, pair), back = Encode(encoding, Swapped(pair));
      for (int i = 0; i < kEncodedSize; ++i) {
        ASSERT_EQ(there[i], back[i]) << name << " input " << i;
      }
    }
  }
}

TEST(Encoding, TwoAreNotReciprocal) {
  const DirectionPair pair = {FromSpherical(0.3, 0.2), FromSpherical(0.9, 2.0)};
  for (const auto& [name, encoding] : kEncodings) {
    EXPECT_EQ(IsReciprocal(encoding),
              encoding != Encoding::kCartesian && encoding != Encoding::kNonreciprocal)
        << name;
    EXPECT_EQ(IsReciprocal(encoding), Encode(encoding, pair) == Encode(encoding, Swapped(pair)))
        << name;
  }
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
  std::array<double, 6> elevations = multiscale;
  elevations[0] = pair.wi.z * pair.wo.z;
  elevations[4] = 0.5 * (pair.wi.z + pair.wo.z);
  std::array<double, 6> nonreciprocal = elevations;
  nonreciprocal[0] = pair.wi.z;
  nonreciprocal[4] = pair.wo.z;
  const double row = 90 * root;  // 50.78: between rows 50 and 51 of a table
  std::array<double, 6> merl = multiscale;
  merl[0] = 4 * (row - 50) * (51 - row);
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
    EXPECT_NEAR(Encode(Encoding::kElevations, pair)[i], elevations[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kNonreciprocal, pair)[i], nonreciprocal[i], 1e-14);
    EXPECT_NEAR(Encode(Encoding::kMerl, pair)[i], merl[i], 1e-12);
    EXPECT_NEAR(Encode(Encoding::kAnisotropic, pair)[i], anisotropic[i], 1e-14);
  }
}

TEST(Encoding, IsotropicOnesDontDependOnPhiH) {
  // Rounding turns h by 1e-16 / sin theta_h, and kMerl's first input grows by up to 360 times its
  // argument.
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

TEST(Encoding, MerlTellsMirrorImagesApart) {
  const DirectionPair pair = {FromSpherical(0.3, 0.2), FromSpherical(0.9, 2.0)};
  const DirectionPair image = {FromSpherical(0.3, -0.2), FromSpherical(0.9, -2.0)};
  EXPECT_GT(std::abs(Encode(Encoding::kMerl, pair)[4] - Encode(Encoding::kMerl, image)[4]), 0.01);
}

using PairJet = ceres::Jet<double, 6>;

Inputs<PairJet> EncodeJets(Encoding encoding, const DirectionPair& pair) {
  const auto& [wi, wo] = pair;
  return Encode(encoding,
                HalfDiffFromPair<PairJet>({PairJet(wi.x, 0), PairJet(wi.y, 1), PairJet(wi.z, 2)},
                                          {PairJet(wo.x, 3), PairJet(wo.y, 4), PairJet(wo.z, 5)}));
}

// The pair with one of its six components moved.
DirectionPair Moved(DirectionPair pair, int component, double by) {
  Vec3& w = component < 3 ? pair.wi : pair.wo;
  (component % 3 == 0 ? w.x : component % 3 == 1 ? w.y : w.z) += by;
  return pair;
}

TEST(Encoding, JetsHaveTheNumericDerivatives) {
  constexpr double kStep = 1e-5;
  constexpr int kPairs = 300;
  for (const auto& [name, encoding] : kEncodings) {
    int kinks = 0;
    double worst = 0.0, largest = 0.0;
    for (const DirectionPair& pair : RandomPairs(kPairs, /*seed=*/5)) {
      const Inputs<double> at = Encode(encoding, pair);
      const Inputs<PairJet> jets = EncodeJets(encoding, pair);
      for (int c = 0; c < 6; ++c) {
        const auto above = Encode(encoding, Moved(pair, c, kStep));
        const auto below = Encode(encoding, Moved(pair, c, -kStep));
        for (int i = 0; i < kEncodedSize; ++i) {
          ASSERT_NEAR(jets[i].a, at[i], 1e-12) << name << " input " << i;
          // At a row of a table, kMerl's first input has a kink.
          const double right = (above[i] - at[i]) / kStep, left = (at[i] - below[i]) / kStep;
          const bool is_kink = std::abs(right - left) > 0.1 * (1.0 + std::abs(right + left));
          kinks += is_kink;
          if (is_kink) continue;
          const double slope = 0.5 * (right + left);
          worst = std::max(worst, std::abs(jets[i].v[c] - slope) / (1.0 + std::abs(slope)));
          largest = std::max(largest, std::abs(slope));
        }
      }
    }
    EXPECT_LT(worst, 1e-4) << name;
    EXPECT_GT(largest, 0.5) << name;
    EXPECT_LT(kinks, kPairs * 6 * kEncodedSize / 100) << name;
  }
}

TEST(Encoding, EachKindOfMaterialHasOneDefault) {
  for (MaterialKind kind :
       {MaterialKind::kTable, MaterialKind::kScattered, MaterialKind::kAnisotropic}) {
    int count = 0;
    for (const auto& [name, encoding] : kEncodings) count += TraitsOf(encoding).default_of == kind;
    EXPECT_EQ(count, 1);
    EXPECT_EQ(TraitsOf(DefaultEncoding(kind)).default_of, kind);
    EXPECT_EQ(IsIsotropic(DefaultEncoding(kind)), kind != MaterialKind::kAnisotropic);
  }
}

TEST(Encoding, NamesThatAreNotInTheTableAreRefused) {
  for (const auto& [name, encoding] : kEncodings) {
    EXPECT_EQ(ParseName(kEncodings, "encoding", name), encoding);
  }
  EXPECT_EQ(ErrorOf([] { ParseName(kEncodings, "encoding", "bilateral"); }),
            "encoding=bilateral is not one of " + JoinNames(kEncodings));
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
