#include "proof/enclosure.h"

#include "network/random_network.h"
#include "pbnbrdf/brdf/operations.h"
#include "proof/network_enclosure.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using std::atan2, std::cos, std::sin;

constexpr int kDim = 3;
using Point = std::array<double, kDim>;
using E = Enclosure<kDim>;

struct TestBox {
  Point center, radius;

  E Variable(int d) const { return E::Variable(d, center[d], radius[d]); }
  // A point of the box; u in [0, 1].
  Point At(const double* u) const {
    Point x;
    for (int d = 0; d < kDim; ++d) x[d] = center[d] + radius[d] * (2.0 * u[d] - 1.0);
    return x;
  }
};

std::vector<TestBox> RandomBoxes(int count, unsigned seed) {
  std::vector<TestBox> boxes;
  const std::vector<double> u = RandomNumbers(std::size_t(count * 6), 0.0, 1.0, seed);
  for (int n = 0; n < count; ++n) {
    TestBox box;
    for (int d = 0; d < kDim; ++d) {
      box.center[d] = 0.2 + u[std::size_t(6 * n + d)];
      box.radius[d] = 0.2 * std::pow(u[std::size_t(6 * n + 3 + d)], 4.0);
    }
    boxes.push_back(box);
  }
  return boxes;
}

// Values at random points of the box are within the range, and as near to that at the centre as the slopes say.
void ExpectHolds(const E& f, const TestBox& box, const std::function<double(const Point&)>& value,
                 const char* what) {
  EXPECT_NEAR(f.center, value(box.center), 1e-12) << what;
  const std::vector<double> u = RandomNumbers(60, 0.0, 1.0, 7);
  for (int n = 0; n < 20; ++n) {
    const Point x = box.At(&u[std::size_t(3 * n)]);
    const double y = value(x);
    Interval from_slopes = {f.center, f.center};
    for (int d = 0; d < kDim; ++d) {
      const double step = x[d] - box.center[d];
      from_slopes = from_slopes + f.slopes[d] * Interval{step, step};
    }
    for (const Interval& interval : {f.range, from_slopes}) {
      EXPECT_GE(y, interval.low - 1e-12) << what;
      EXPECT_LE(y, interval.high + 1e-12) << what;
    }
  }
}

TEST(Enclosure, HoldsAllValuesOfEachOperation) {
  const auto functions =
      std::make_tuple([](auto x, auto y, auto z) { return x + y * z - x / y; },
                      [](auto x, auto y, auto z) { return sqrt(x * y) * log(z + 0.1) / 3.0; },
                      [](auto x, auto y, auto z) { return sin(x) * cos(3.0 * y) - cos(z); },
                      [](auto x, auto y, auto z) { return atan2(x, y + z); },
                      [](auto x, auto y, auto z) { return Max(x - y, 0.3 * z - 0.2) * (1.0 - x); },
                      [](auto x, auto y, auto z) { return Min(x, y) / (2.0 + z) - 1.0 / x; });
  for (const TestBox& box : RandomBoxes(300, 1)) {
    std::apply(
        [&](const auto&... function) {
          int k = 0;
          (ExpectHolds(
               function(box.Variable(0), box.Variable(1), box.Variable(2)), box,
               [&](const Point& x) { return function(x[0], x[1], x[2]); },
               StrCat("function ", k++).c_str()),
           ...);
        },
        functions);
  }
}

TEST(Enclosure, IsTightToSecondOrder) {
  for (const double radius : {0.1, 0.01, 0.001}) {
    const E x = E::Variable(0, 1.0, radius);
    const E f = sin(x) * x;
    EXPECT_NEAR(f.slopes[0].low, std::sin(1.0) + std::cos(1.0), 3.0 * radius);
    EXPECT_NEAR(f.slopes[0].high, std::sin(1.0) + std::cos(1.0), 3.0 * radius);
  }
}

TEST(Interval, ZeroTimesInfinityIsZero) {
  const Interval all = Inverse({0.0, 2.0});
  EXPECT_EQ(all.low, 0.5);
  EXPECT_TRUE(std::isinf(all.high));
  EXPECT_EQ((all * Interval{0.0, 0.0}).high, 0.0);
  EXPECT_TRUE(std::isinf(Inverse({-1.0, 1.0}).low));
}

// The network's outputs, before the output unit.
std::vector<double> OutputsOf(const NeuralBrdf& network, const Inputs<double>& inputs) {
  std::vector<double> x(inputs.begin(), inputs.end());
  for (const LayerWeights& layer : network.Layers()) {
    std::vector<double> y;
    for (int k = 0; k < layer.out; ++k) {
      double sum = layer.bias(k);
      for (int i = 0; i < layer.in; ++i) sum += layer.weight(k, i) * x[std::size_t(i)];
      const bool is_relu = network.shape().activation() == Activation::kRelu;
      y.push_back(!layer.hidden ? sum : is_relu ? std::max(sum, 0.0) : std::tanh(sum));
    }
    x = y;
  }
  return x;
}

// The input i of a network is a linear function of the variables.
Inputs<E> LinearInputs(const TestBox& box) {
  Inputs<E> inputs;
  for (int i = 0; i < kEncodedSize; ++i) {
    inputs[i] = 0.3 * box.Variable(i % kDim) - 0.1 * double(i) * box.Variable((i + 1) % kDim);
  }
  return inputs;
}

TEST(NetworkEnclosure, HoldsAllValues) {
  for (const Activation activation : {Activation::kTanh, Activation::kRelu}) {
    const NetworkShape shape(Encoding::kMerl, {9, 7}, activation);
    const NeuralBrdf network(shape, RandomWeights(shape, 1.0, /*seed=*/3));
    NetworkEnclosure<kDim> enclosure(network);
    const std::vector<TestBox> boxes = RandomBoxes(NetworkEnclosure<kDim>::kBoxes, 5);
    for (std::size_t n = 0; n < boxes.size(); ++n) {
      enclosure.SetInputs(int(n), LinearInputs(boxes[n]), boxes[n].radius);
    }
    enclosure.Run();
    for (std::size_t n = 0; n < boxes.size(); ++n) {
      for (int c = 0; c < 3; ++c) {
        ExpectHolds(
            enclosure.Reflectance(int(n), c), boxes[n],
            [&](const Point& x) {
              Inputs<double> inputs;
              const Inputs<E> at = LinearInputs({x, {}});
              for (int i = 0; i < kEncodedSize; ++i) inputs[i] = at[i].center;
              return ClampedReflectance(OutputsOf(network, inputs)[std::size_t(c)]);
            },
            "network");
      }
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
