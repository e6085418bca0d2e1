#include "gradient_check.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

// The sum of cost(w_i), with slopes slope(w_i), whose first one is said to be `wrong` times as large.
class Separable final : public Objective {
 public:
  Separable(double (*cost)(double), double (*slope)(double), double wrong = 1.0)
      : cost_(cost),
        slope_(slope),
        wrong_(wrong),
        shape_(Encoding::kMerl, {1}, Activation::kTanh) {}

  const NetworkShape& shape() const override { return shape_; }
  std::size_t num_samples() const override { return 1; }
  void Grow(std::size_t) override {}
  void SetEnergy(double, std::span<const EnergyStratum>) override {}
  double Cost(const double* weights) override {
    double sum = 0.0;
    for (int i = 0; i < shape_.num_weights(); ++i) sum += cost_(weights[i]);
    return sum;
  }
  bool Gradient(const double* weights, double* cost, double* gradient) override {
    *cost = Cost(weights);
    for (int i = 0; i < shape_.num_weights(); ++i) gradient[i] = slope_(weights[i]);
    gradient[0] *= wrong_;
    return std::isfinite(*cost);
  }
  bool Linearize(const double*, CurvaturePart, Linearization*) override { return false; }
  std::vector<double> Curve(const double*, const double*, CurvaturePart) override { return {}; }
  bool SumCurvatureInDouble() override { return false; }
  double HessianRounding() const override { return 1e-15; }
  double MeanAbsLogError(const double*) override { return 0.0; }
  const EnergyWork& energy_work() const override { return energy_work_; }

 private:
  double (*cost_)(double);
  double (*slope_)(double);
  double wrong_;
  NetworkShape shape_;
  EnergyWork energy_work_;
};

GradientCheck Check(Objective* objective, double weight) {
  const std::vector<double> weights(objective->shape().num_weights(), weight);
  return CheckGradient(objective, /*loss_scale=*/1e-3, weights, /*directions=*/20, /*seed=*/1);
}

double Smooth(double w) { return std::exp(std::sin(3.0 * w)); }
double SmoothSlope(double w) { return 3.0 * std::cos(3.0 * w) * Smooth(w); }
// A kink at 1.
double Kinked(double w) { return w > 1.0 ? 2.0 * w - 1.0 : w; }
double KinkedSlope(double w) { return w > 1.0 ? 2.0 : 1.0; }

TEST(CheckGradient, AgreesWithARightGradient) {
  Separable objective(Smooth, SmoothSlope);
  const GradientCheck check = Check(&objective, 0.4);
  EXPECT_EQ(check.resolved, 20);
  EXPECT_LT(check.worst_error, 1e-8);
}

TEST(CheckGradient, CatchesAWrongComponent) {
  Separable objective(Smooth, SmoothSlope, /*wrong=*/1.01);
  const GradientCheck check = Check(&objective, 0.4);
  EXPECT_EQ(check.resolved, 20);
  EXPECT_GT(check.worst_error, 1e-4);
}

TEST(CheckGradient, DoesntJudgeAtAKink) {
  Separable objective(Kinked, KinkedSlope);
  for (double distance : {0.0, 1e-12, 1e-9}) {
    const GradientCheck check = Check(&objective, 1.0 + distance);
    EXPECT_EQ(check.unresolved, 20) << distance;
    EXPECT_EQ(check.worst_error, 0.0) << distance;
  }
}

TEST(CheckGradient, JudgesNearAKink) {
  for (double distance : {1e-2, 1e-4, -1e-3}) {
    Separable right(Kinked, KinkedSlope), wrong(Kinked, KinkedSlope, /*wrong=*/1.1);
    EXPECT_GT(Check(&right, 1.0 + distance).resolved, 15) << distance;
    EXPECT_LT(Check(&right, 1.0 + distance).worst_error, 1e-6) << distance;
    EXPECT_GT(Check(&wrong, 1.0 + distance).worst_error, 1e-3) << distance;
  }
}

TEST(CheckGradient, JudgesNothingThatIsNotFinite) {
  Separable objective([](double) { return std::nan(""); }, SmoothSlope);
  EXPECT_EQ(Check(&objective, 0.4).unresolved, 20);
}

}  // namespace
}  // namespace pbnbrdf
