#include "proof/network_enclosure.h"

#include <cmath>

#include "kernels/passes.h"

namespace pbnbrdf {
namespace {

// A derivative of which nothing is known. Finite, so that it can be multiplied by weights that are 0.
constexpr double kUnknown = 1e150;
// All inputs of all encodings (expressions-inl.h) are within.
constexpr double kLargestInput = 2.5;
// tanh is 1 there, in double precision.
constexpr double kSaturated = 20.0;
// Largest absolute second derivative of tanh.
constexpr double kTanhCurvature = 0.7698003589195011;  // 4 / (3 sqrt(3))

}  // namespace

template <int D>
NetworkEnclosure<D>::Layer::Layer(int units)
    : size(units), center(std::size_t(units * kBoxes)), radius(center.size()) {
  slope.fill(AlignedVector<double>(center.size()));
  slope_radius.fill(AlignedVector<double>(center.size()));
}

template <int D>
NetworkEnclosure<D>::NetworkEnclosure(const NeuralBrdf& network)
    : activation_(network.shape().activation()) {
  layers_.emplace_back(kEncodedSize);
  for (const LayerWeights& layer : network.Layers()) {
    Weights weights;
    weights.with_bias.assign(layer.block, layer.block + layer.out * (layer.in + 1));
    weights.without_bias = weights.with_bias;
    for (int k = 0; k < layer.out; ++k) {
      weights.without_bias[std::size_t(k * (layer.in + 1) + layer.in)] = 0.0;
    }
    weights.absolute = weights.without_bias;
    for (double& weight : weights.absolute) weight = std::abs(weight);
    weights_.push_back(weights);
    layers_.emplace_back(layer.out);
  }
  radii_.fill(AlignedVector<double>(kBoxes));
}

template <int D>
void NetworkEnclosure<D>::SetInputs(int box, const Inputs<Enclosure<D>>& inputs,
                                    const std::array<double, D>& radii) {
  Layer& layer = layers_.front();
  for (int d = 0; d < D; ++d) radii_[d][box] = radii[d];
  for (int i = 0; i < layer.size; ++i) {
    const Enclosure<D>& x = inputs[i];
    const int at = i * kBoxes + box;
    layer.center[at] = x.center;
    layer.radius[at] = std::min(std::max(x.range.high - x.center, x.center - x.range.low),
                                kLargestInput + std::abs(x.center));
    for (int d = 0; d < D; ++d) {
      const double middle = 0.5 * (x.slopes[d].low + x.slopes[d].high);
      const double radius = 0.5 * (x.slopes[d].high - x.slopes[d].low);
      const bool is_known = std::abs(middle) + radius < kUnknown;  // false for NaN
      layer.slope[d][at] = is_known ? middle : 0.0;
      layer.slope_radius[d][at] = is_known ? radius : kUnknown;
    }
  }
}

template <int D>
void NetworkEnclosure<D>::Run() {
  Tighten(&layers_.front());
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    Layer& out = layers_[k + 1];
    Multiply(weights_[k], layers_[k], &out);
    Tighten(&out);
    if (k + 1 == weights_.size()) break;
    if (activation_ == Activation::kTanh) {
      ApplyTanh(&out);
    } else {
      ApplyRelu(&out);
    }
  }
}

template <int D>
void NetworkEnclosure<D>::Multiply(const Weights& weights, const Layer& in, Layer* out) {
  const auto multiply = [&](const AlignedVector<double>& by, const AlignedVector<double>& x,
                            AlignedVector<double>* y) {
    kernels::Dense(by.data(), out->size, in.size, x.data(), y->data());
  };
  multiply(weights.with_bias, in.center, &out->center);
  multiply(weights.absolute, in.radius, &out->radius);
  for (int d = 0; d < D; ++d) {
    multiply(weights.without_bias, in.slope[d], &out->slope[d]);
    multiply(weights.absolute, in.slope_radius[d], &out->slope_radius[d]);
  }
}

// The radius is at most what the derivatives allow for.
template <int D>
void NetworkEnclosure<D>::Tighten(Layer* layer) const {
  AlignedVector<double> reach(kBoxes);
  for (int i = 0; i < layer->size * kBoxes; i += kBoxes) {
    std::fill(reach.begin(), reach.end(), 0.0);
    for (int d = 0; d < D; ++d) {
      const double *slope = &layer->slope[d][i], *radius = &layer->slope_radius[d][i];
      for (int n = 0; n < kBoxes; ++n) {
        reach[n] += (std::abs(slope[n]) + radius[n]) * radii_[d][n];
      }
    }
    double* radius = &layer->radius[i];
    for (int n = 0; n < kBoxes; ++n) radius[n] = std::min(radius[n], reach[n]);
  }
}

// With y = tanh(x) at the centre, s = 1 - y^2 its slope there and r the radius of x, slopes within are at most
// min(kTanhCurvature r, s (exp(2 r) - 1)) from s, as |s'| = 2 |y| s <= 2 s; exp(t) - 1 <= t + t^2 for t <= 1.
template <int D>
void NetworkEnclosure<D>::ApplyTanh(Layer* layer) const {
  AlignedVector<double>& exponentials = layer->center;  // tanh(x) = 1 - 2 / (exp(2 x) + 1)
  for (double& x : exponentials) x = 2.0 * std::clamp(x, -kSaturated, kSaturated);
  kernels::Exp(exponentials.data(), exponentials.size());
  for (int i = 0; i < layer->size * kBoxes; ++i) {
    const double y = 1.0 - 2.0 / (exponentials[i] + 1.0), r = layer->radius[i], s = 1.0 - y * y;
    const double t = 2.0 * r;
    const double change = std::min(kTanhCurvature * r, t <= 1.0 ? s * (t + t * t) : 1.0);
    const double low = std::max(s - change, 0.0), high = std::min(s + change, 1.0);
    const double middle = 0.5 * (low + high), spread = 0.5 * (high - low);
    layer->center[i] = y;
    layer->radius[i] = std::min(r * high, 1.0 + std::abs(y));
    for (int d = 0; d < D; ++d) {
      double &slope = layer->slope[d][i], &radius = layer->slope_radius[d][i];
      radius = high * radius + spread * std::abs(slope);
      slope *= middle;
    }
  }
}

template <int D>
void NetworkEnclosure<D>::ApplyRelu(Layer* layer) const {
  for (int i = 0; i < layer->size * kBoxes; ++i) {
    const double x = layer->center[i], r = layer->radius[i];
    if (x - r >= 0.0) continue;
    const double high = x + r > 0.0 ? 1.0 : 0.0;  // slopes are 0 to high
    layer->center[i] = std::max(x, 0.0);
    layer->radius[i] = x < 0.0 ? std::max(x + r, 0.0) : r;
    for (int d = 0; d < D; ++d) {
      double &slope = layer->slope[d][i], &radius = layer->slope_radius[d][i];
      radius = high * (radius + 0.5 * std::abs(slope));
      slope *= 0.5 * high;
    }
  }
}

template <int D>
Enclosure<D> NetworkEnclosure<D>::Reflectance(int box, int channel) const {
  const Layer& z = layers_.back();
  const int at = (z.size == 1 ? 0 : channel) * kBoxes + box;
  const auto reflectance = [](double x) { return ClampedReflectance(x); };
  const double low = z.center[at] - z.radius[at], high = z.center[at] + z.radius[at];
  Enclosure<D> f(reflectance(z.center[at]));
  f.range = {reflectance(low), reflectance(high)};
  const bool may_be_clamped = f.range.high >= Brdf::kLargestValue;
  const Interval per_z = {low > 0.0 && !may_be_clamped ? 1.0 + f.range.low : 0.0,
                          high > 0.0 ? 1.0 + f.range.high : 0.0};
  for (int d = 0; d < D; ++d) {
    const double slope = z.slope[d][at], radius = z.slope_radius[d][at];
    f.slopes[d] = per_z * Interval{slope - radius, slope + radius};
  }
  return f;
}

// z is at most z+ = max(0, z at the centre) + sum over d of k_d |x_d - centre_d|, k_d the steepest slope, and f is at most
// expm1(z+). The mean of exp(k |x|) over -r to r is expm1(k r) / (k r).
template <int D>
double NetworkEnclosure<D>::LargestMean(int box, int channel, int averaged) const {
  const Layer& z = layers_.back();
  const int at = (z.size == 1 ? 0 : channel) * kBoxes + box;
  double exponent = std::max(z.center[at], 0.0), factor = 1.0;
  for (int d = 0; d < D; ++d) {
    const double change = (std::abs(z.slope[d][at]) + z.slope_radius[d][at]) * radii_[d][box];
    if (d >= averaged) exponent += change;
    if (d < averaged && change > 0.0) factor *= std::expm1(change) / change;
  }
  return std::exp(exponent) * factor - 1.0;
}

template class NetworkEnclosure<3>;
template class NetworkEnclosure<4>;

}  // namespace pbnbrdf
