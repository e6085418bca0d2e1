#include "pbnbrdf/export/sampling_lobe.h"

#include "pbnbrdf/brdf/analytic.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

// f for which f cos, with wo given and wi drawn, is just the density of the lobe.
class LobeBrdf final : public PointwiseBrdf {
 public:
  explicit LobeBrdf(const SamplingLobe& lobe) : lobe_(lobe) {}
  std::string Description() const override { return "a sampling lobe"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    const Vec3 sum = pair.wi + pair.wo, h = (1.0 / Length(sum)) * sum;
    const double a2 = lobe_.alpha * lobe_.alpha, cos2 = h.z * h.z;
    const double d = a2 / (kPi * std::pow(cos2 * (a2 - 1.0) + 1.0, 2));
    const double cos_v = pair.wo.z, tan2_v = 1.0 / (cos_v * cos_v) - 1.0;
    const double g1 = 2.0 / (1.0 + std::sqrt(1.0 + a2 * tan2_v));
    const double pdf =
        lobe_.weight * g1 * d / (4.0 * cos_v) + (1.0 - lobe_.weight) * pair.wi.z / kPi;
    const double f = pdf / pair.wi.z;
    return {f, f, f};
  }

 private:
  SamplingLobe lobe_;
};

TEST(SamplingLobe, FindsTheLobeThatItIs) {
  // Of the grid's 32 steps from 0.002 to 1; of wider lobes the horizon cuts off a part.
  for (int a : {3, 8, 14, 20}) {
    for (double weight : {0.2, 0.7}) {
      const double alpha = std::pow(0.002, 1.0 - a / 31.0);
      const SamplingLobe lobe = FitSamplingLobe(LobeBrdf({alpha, weight}));
      EXPECT_NEAR(std::log(lobe.alpha / alpha), 0.0, 0.25) << alpha << " " << weight;
      EXPECT_NEAR(lobe.weight, weight, 0.11) << alpha << " " << weight;
    }
  }
}

TEST(SamplingLobe, AMatteMaterialIsDrawnByCosine) {
  EXPECT_NEAR(FitSamplingLobe(LambertBrdf({0.5, 0.5, 0.5})).weight, 0.1, 1e-12);
}

}  // namespace
}  // namespace pbnbrdf
