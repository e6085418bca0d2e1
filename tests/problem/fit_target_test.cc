#include "problem/fit_target.h"

#include "brdf/direction_pairs.h"

namespace pbnbrdf {
namespace {

// Stored as cos theta_i, likeliest twice that: neither is reciprocal.
class Measured : public Brdf {
 public:
  explicit Measured(double factor = 1.0) : factor_(factor) {}

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) values[n].fill(factor_ * pairs[n].wi.z);
  }
  std::unique_ptr<Brdf> BestEstimate(Estimate estimate) const override {
    return std::make_unique<Measured>(estimate == Estimate::kLikeliest ? 2.0 : 1.0);
  }
  bool IsReciprocal() const override { return false; }
  std::string Description() const override { return "cos theta_i"; }

 private:
  double factor_;
};

double ValueOf(Encoding encoding, const DirectionPair& pair) {
  Rgb value;
  FitTarget(Measured(), encoding)->EvaluateUnclipped({&pair, 1}, {&value, 1});
  return value[0];
}

TEST(FitTarget, IsReciprocalWhereTheEncodingIs) {
  for (const DirectionPair& pair : RandomPairs(100, /*seed=*/1)) {
    EXPECT_NEAR(ValueOf(Encoding::kElevations, pair), pair.wi.z + pair.wo.z, 1e-12);
    EXPECT_EQ(ValueOf(Encoding::kNonreciprocal, pair), pair.wi.z);
    EXPECT_EQ(ValueOf(Encoding::kCartesian, pair), pair.wi.z);
  }
}

}  // namespace
}  // namespace pbnbrdf
