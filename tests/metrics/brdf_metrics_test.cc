#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/problem/sampling.h"

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/metrics/color.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"

namespace pbnbrdf {
namespace {

// f = 1 + sin theta_d cos phi_d: exchanging wi and wo negates the second part.
class SkewedBrdf : public Brdf {
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

class UnknownSkewedBrdf final : public SkewedBrdf {
 public:
  bool IsKnown(const DirectionPair&) const override { return false; }
};

TEST(Reciprocity, OfWhatIsNotKnownDoesNotCount) {
  const double all = MeasureReciprocity(SkewedBrdf()).hrl;
  const double below = MeasureReciprocity(UnknownSkewedBrdf()).hrl;
  EXPECT_GT(below, 0.1 * all);
  EXPECT_LT(below, 0.9 * all);
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
      MeasureErrors(HeldOutSamples(WavingBrdf(), 20000, /*seed=*/1), LambertBrdf({kPi, kPi, kPi}));
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
  const HeldOutErrors errors = MeasureErrors(HeldOutSamples(*gold, 1000, /*seed=*/1), *gold);
  EXPECT_EQ(errors.mean_abs_log_error, 0.0);
  EXPECT_EQ(errors.rmse, 0.0);
  EXPECT_EQ(errors.chromaticity_error, 0.0);
  EXPECT_EQ(errors.samples, 1000u);
}

TEST(HeldOutErrors, OfTwoLambertiansAreBounded) {
  const double a = 0.4 / kPi, b = 0.8 / kPi;
  const HeldOutErrors errors =
      MeasureErrors(HeldOutSamples(LambertBrdf({0.4, 0.4, 0.4}), 20000, /*seed=*/1),
                    LambertBrdf({0.8, 0.8, 0.8}));
  EXPECT_GT(errors.mean_abs_log_error, 0.0);
  EXPECT_LT(errors.mean_abs_log_error, std::log1p(b) - std::log1p(a));
  EXPECT_LT(errors.rmse, b - a);
  EXPECT_GT(errors.rmse, 0.3 * (b - a));
  EXPECT_LT(errors.chromaticity_error, std::log1p(3 * b * b) - std::log1p(3 * a * a));
}

TEST(ColorErrors, OfAMaterialAgainstItselfAreZero) {
  const auto gold = MakeBuiltin("satin-gold");
  const ColorErrors errors = MeasureColorErrors(HeldOutSamples(*gold, 1000, /*seed=*/1), *gold);
  EXPECT_EQ(errors.delta_e_mean, 0.0);
  EXPECT_EQ(errors.delta_e_p95, 0.0);
  EXPECT_EQ(errors.dark_hue_chroma_mean, 0.0);
  EXPECT_EQ(errors.dark_hue_chroma_p95, 0.0);
  EXPECT_EQ(errors.samples, 1000u);
  EXPECT_GT(errors.dark_samples, 0u);
  EXPECT_LT(errors.dark_samples, 1000u);
}

// Its lit colour is the same for all directions.
class EvenlyLitBrdf final : public Brdf {
 public:
  explicit EvenlyLitBrdf(const Rgb& color) : color_(color) {}
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double scale = 1.0 / (kPi * pairs[n].wi.z);
      for (int c = 0; c < 3; ++c) values[n][c] = scale * color_[c];
    }
  }
  std::string Description() const override { return "evenly lit"; }

 private:
  Rgb color_;
};

TEST(ColorErrors, OfConstantColoursAreTheirDifference) {
  const Rgb x = {0.05, 0.02, 0.01}, y = {0.06, 0.02, 0.02};
  const ColorErrors errors =
      MeasureColorErrors(HeldOutSamples(EvenlyLitBrdf(x), 500, /*seed=*/1), EvenlyLitBrdf(y));
  const double delta_e = DeltaE2000(ToLab(x), ToLab(y));
  const double hue_chroma = HueChromaDifference(ToLab(x), ToLab(y));
  EXPECT_NEAR(errors.delta_e_mean, delta_e, 1e-9);
  EXPECT_NEAR(errors.delta_e_p95, delta_e, 1e-9);
  EXPECT_NEAR(errors.dark_hue_chroma_mean, hue_chroma, 1e-9);
  EXPECT_NEAR(errors.dark_hue_chroma_p95, hue_chroma, 1e-9);
  EXPECT_EQ(errors.dark_samples, 500u);
}

TEST(ColorErrors, WithoutDarkSamplesTheirsAreZero) {
  const ColorErrors errors =
      MeasureColorErrors(HeldOutSamples(EvenlyLitBrdf({0.2, 0.2, 0.2}), 100, /*seed=*/1),
                         EvenlyLitBrdf({0.3, 0.2, 0.2}));
  EXPECT_GT(errors.delta_e_mean, 1.0);
  EXPECT_EQ(errors.dark_samples, 0u);
  EXPECT_EQ(errors.dark_hue_chroma_mean, 0.0);
  EXPECT_EQ(errors.dark_hue_chroma_p95, 0.0);
}

TEST(ColorErrors, BeyondWhiteADisplayShowsNoDifference) {
  const ColorErrors errors =
      MeasureColorErrors(HeldOutSamples(EvenlyLitBrdf({1.1, 1.5, 1e9}), 100, /*seed=*/1),
                         EvenlyLitBrdf({2.0, 1.1, 3.0}));
  EXPECT_EQ(errors.delta_e_p95, 0.0);
}

// Differs from black in about a tenth of the samples.
class SpottedBrdf final : public Brdf {
 public:
  explicit SpottedBrdf(double value) : value_(value) {}
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double f = ToAngles(pairs[n]).phi_d < 0.2 * kPi ? value_ : 0.0;
      values[n] = {f, f, f};
    }
  }
  std::string Description() const override { return "spotted"; }

 private:
  double value_;
};

TEST(ColorErrors, ThePercentileIsNotTheMean) {
  const LambertBrdf black({0, 0, 0});
  const ColorErrors errors =
      MeasureColorErrors(HeldOutSamples(black, 20000, /*seed=*/1), SpottedBrdf(1e9));
  EXPECT_NEAR(errors.delta_e_mean, 10.0, 2.0);  // black to white is 100
  EXPECT_NEAR(errors.delta_e_p95, 100.0, 1e-9);
  EXPECT_EQ(errors.dark_samples, 20000u);
}

TEST(ColorErrors, NotANumberIsNotHidden) {
  const ColorErrors errors = MeasureColorErrors(
      HeldOutSamples(LambertBrdf({0, 0, 0}), 2000, /*seed=*/1), SpottedBrdf(NAN));
  EXPECT_TRUE(std::isnan(errors.delta_e_mean));
  EXPECT_TRUE(std::isnan(errors.delta_e_p95));
}

}  // namespace
}  // namespace pbnbrdf
