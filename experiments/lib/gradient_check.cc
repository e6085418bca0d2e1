#include "gradient_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace pbnbrdf {
namespace {

constexpr int kRows = 7;  // of Ridders' table: steps from h to h / 64
constexpr double kFirstSteps[] = {1e-2, 1e-4, 1e-6};
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();

struct Slope {
  double value = 0.0;
  double error = std::numeric_limits<double>::infinity();
};

// Of f at 0. f(t) must be finite for |t| <= first_step, or the error is infinite. f is rounded as its
// value and its root are, the residuals being differences of numbers of about 1, and by `floor`.
template <typename Function>
Slope Ridders(Function f, double f0, double first_step, double floor) {
  std::array<double, kRows> row, last_row, jumps;
  Slope best;
  for (int i = 0; i < kRows; ++i) {
    const double h = std::ldexp(first_step, -i);
    const double up = f(h), down = f(-h);
    const double largest = std::max({up, down, f0});  // costs aren't negative
    const double rounding = (kRounding * (largest + std::sqrt(largest)) + floor) / h;
    row[0] = (up - down) / (2.0 * h);
    jumps[i] = (up - 2.0 * f0 + down) / h;
    if (!std::isfinite(row[0]) || !std::isfinite(jumps[i])) return {};
    // Where f is smooth the jump is h f'', which the extrapolation takes away.
    const auto jump = [&](int k) { return std::abs(2.0 * jumps[k] - jumps[k - 1]); };
    double power = 4.0;
    for (int j = 1; j <= i; ++j, power *= 4.0) {
      row[j] = (power * row[j - 1] - last_row[j - 1]) / (power - 1.0);
      if (i < 2) continue;
      const double spread =
          std::max(std::abs(row[j] - row[j - 1]), std::abs(row[j] - last_row[j - 1]));
      const double error = spread + std::max(jump(i), jump(i - 1)) + rounding;
      if (error < best.error) best = {row[j], error};
    }
    last_row = row;
  }
  return best;
}

std::vector<double> RandomDirection(const std::vector<double>& weights, std::mt19937_64& random) {
  double largest = 1e-300, squares = 0.0;
  for (double w : weights) largest = std::max(largest, std::abs(w));
  for (double w : weights) squares += (w / largest) * (w / largest);
  const double rms = largest * std::sqrt(squares / static_cast<double>(weights.size()));
  std::vector<double> direction;
  for (double w : weights) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
    direction.push_back(u * (std::abs(w) + 0.1 * rms + 1e-3));
  }
  return direction;
}

}  // namespace

void GradientCheck::Add(const GradientCheck& other) {
  worst_error = std::max(worst_error, other.worst_error);
  resolved += other.resolved;
  unresolved += other.unresolved;
}

GradientCheck CheckGradient(Objective* objective, double loss_scale,
                            const std::vector<double>& weights, int directions, unsigned seed) {
  GradientCheck check;
  double cost = 0.0;
  std::vector<double> gradient(weights.size()), moved(weights.size());
  if (!objective->Gradient(weights.data(), &cost, gradient.data())) {
    check.unresolved = directions;
    return check;
  }
  const double f0 = objective->Cost(weights.data());
  std::mt19937_64 random(seed);
  for (int k = 0; k < directions; ++k) {
    const std::vector<double> direction = RandomDirection(weights, random);
    const auto f = [&](double t) {
      for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = weights[i] + t * direction[i];
      return objective->Cost(moved.data());
    };
    Slope numeric;
    for (double step : kFirstSteps) {
      const Slope slope = Ridders(f, f0, step, kRounding * loss_scale * loss_scale);
      if (slope.error < numeric.error) numeric = slope;
    }
    double analytic = 0.0, scale = std::abs(numeric.value);
    double sum = 0.0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      analytic += gradient[i] * direction[i];
      sum += std::abs(gradient[i] * direction[i]);
    }
    scale = std::max(scale, sum);
    if (!(numeric.error <= GradientCheck::kResolution * scale)) {
      ++check.unresolved;
      continue;
    }
    ++check.resolved;
    const double error = scale > 0.0 ? std::abs(analytic - numeric.value) / scale : 0.0;
    check.worst_error = std::max(check.worst_error, error);
  }
  return check;
}

}  // namespace pbnbrdf
