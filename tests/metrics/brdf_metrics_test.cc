#include "pbnbrdf/metrics/brdf_metrics.h"

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/analytic.h"
#include "pbnbrdf/brdf/builtin.h"

namespace pbnbrdf {
namespace {

// f = 1 + sin theta_d cos phi_d: exchanging wi and wo negates the second part.
class SkewedBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double f = 1.0 + ToHalfDiff(pairs[n]).d.x;
      values[n] = {f, f, f};
    }
  }
  std::string Description() const override { return "skewed"; }
};

TEST(Reciprocity, OfASkewedBrdfIsThatOfTheIntegrals) {
  // HRL: mean of (2 sin td cos pd)^2 = 4 * 1/2 * 1/2. HCL: mean of 2 sin td = 4 / pi.
  const Reciprocity r = MeasureReciprocity(SkewedBrdf());
  EXPECT_NEAR(r.hrl, 1.0, 1e-3);
  EXPECT_NEAR(r.hcl, 4.0 / kPi, 1e-3);
}

// f = 1 + sin theta_d cos phi_d cos phi_h.
class TurningBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double f = 1.0 + ToHalfDiff(pairs[n]).d.x * std::cos(ToAngles(pairs[n]).phi_h);
      values[n] = {f, f, f};
    }
  }
  bool IsIsotropic() const override { return false; }
  std::string Description() const override { return "turning"; }
};

TEST(Reciprocity, OfAnAnisotropicBrdfIsTheMeanOverPhiH) {
  // As above, times the mean of cos^2 phi_h = 1 / 2, and that of |cos phi_h| = 2 / pi.
  const Reciprocity r = MeasureReciprocity(TurningBrdf());
  EXPECT_NEAR(r.hrl, 0.5, 1e-3);
  EXPECT_NEAR(r.hcl, 4.0 / kPi * 2.0 / kPi, 0.03);
}

// f = 1 + sin^2 phi_h: that of a Lambertian at phi_h = 0.
class WavingBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double s = std::sin(ToAngles(pairs[n]).phi_h), f = 1.0 + s * s;
      values[n] = {f, f, f};
    }
  }
  bool IsIsotropic() const override { return false; }
  std::string Description() const override { return "waving"; }
};

TEST(HeldOutErrors, OfAnAnisotropicReferenceAreTakenOverPhiH) {
  const HeldOutErrors errors =
      MeasureErrors(WavingBrdf(), LambertBrdf({kPi, kPi, kPi}), 20000, /*seed=*/1);
  EXPECT_GT(errors.mean_abs_log_error, 0.05);
  // (sin^2 phi_h cos_i)^2 has the mean 3/8 mean cos_i^2, in [0, 3/8].
  EXPECT_GT(errors.rmse, 0.2);
  EXPECT_LT(errors.rmse, std::sqrt(0.375));
}

TEST(Reciprocity, OfALambertianIsZero) {
  const Reciprocity r = MeasureReciprocity(LambertBrdf({0.5, 0.5, 0.5}));
  EXPECT_EQ(r.hrl, 0.0);
  EXPECT_EQ(r.hcl, 0.0);
}

TEST(Energy, OfLambertians) {
  const Energy dark = MeasureEnergy(LambertBrdf({0.2, 0.7, 0.4}));
  EXPECT_NEAR(dark.max_directional_albedo, 0.7, 1e-3);
  EXPECT_EQ(dark.eal, 0.0);
  // Channel albedos 1.3, 0.5, 0.5: excess 0.3 in one channel of three, over 2 pi.
  const Energy bright = MeasureEnergy(LambertBrdf({1.3, 0.5, 0.5}));
  EXPECT_NEAR(bright.max_directional_albedo, 1.3, 2e-3);
  EXPECT_NEAR(bright.eal, 2 * kPi * 0.3 / 3, 2e-3);
}

TEST(HeldOutErrors, OfAMaterialAgainstItselfAreZero) {
  const auto gold = MakeBuiltin("satin-gold");
  const HeldOutErrors errors = MeasureErrors(*gold, *gold, 1000, /*seed=*/1);
  EXPECT_EQ(errors.mean_abs_log_error, 0.0);
  EXPECT_EQ(errors.rmse, 0.0);
  EXPECT_EQ(errors.chromaticity_error, 0.0);
  EXPECT_EQ(errors.samples, 1000u);
}

TEST(HeldOutErrors, OfTwoLambertiansAreBounded) {
  const double a = 0.4 / kPi, b = 0.8 / kPi;
  const HeldOutErrors errors =
      MeasureErrors(LambertBrdf({0.4, 0.4, 0.4}), LambertBrdf({0.8, 0.8, 0.8}), 20000, /*seed=*/1);
  EXPECT_GT(errors.mean_abs_log_error, 0.0);
  EXPECT_LT(errors.mean_abs_log_error, std::log1p(b) - std::log1p(a));
  EXPECT_LT(errors.rmse, b - a);
  EXPECT_GT(errors.rmse, 0.3 * (b - a));
  EXPECT_LT(errors.chromaticity_error, std::log1p(3 * b * b) - std::log1p(3 * a * a));
}

}  // namespace
}  // namespace pbnbrdf
