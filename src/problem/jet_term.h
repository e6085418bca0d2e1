// jet_term.h: any functor as a term over samples, differentiated by jets.
#pragma once

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/jet.h>

#include <array>
#include <vector>

#include "pbnbrdf/residuals/network_residual.h"
#include "problem/sample_term.h"

namespace pbnbrdf {

// A functor of the weights for Ceres, which differentiates it by jets.
template <class Functor>
ceres::CostFunction* NewAutodiffCostFunction(
    const NetworkShape& shape, std::vector<typename NetworkResidual<Functor>::Input> inputs,
    Functor functor) {
  constexpr int kJetSize = 16;  // derivatives that a pass through the network carries
  auto* cost = new ceres::DynamicAutoDiffCostFunction<NetworkResidual<Functor>, kJetSize>(
      new NetworkResidual<Functor>(shape, std::move(inputs), std::move(functor)));
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    cost->AddParameterBlock(shape.block_size(layer));
  }
  cost->SetNumResiduals(Functor::kNumResiduals);
  return cost;
}

// Any functor, differentiated by jets of the three outputs.
template <class Functor>
class JetTerm : public SampleTerm {
 public:
  static constexpr int kRows = Functor::kNumResiduals;

  int rows() const override { return kRows; }

  void Grow(const EncodedSamples& samples, std::size_t count) override {
    functors_.reserve(count);
    for (std::size_t n = functors_.size(); n < count; ++n) {
      functors_.emplace_back(samples.samples()[n].value, samples.cos_i(n));
    }
  }

  void Evaluate(std::size_t b, int size, const double* z, TermBatch* to) const override {
    for (int n = 0; n < size; ++n) {
      const std::array<Jet, kRows> r = Linearize(functors_[b * kBatch + n], z + n);
      for (int row = 0; row < kRows; ++row) {
        to->residuals[row * kBatch + n] = r[row].a;
        for (int c = 0; c < kChannels; ++c) {
          to->slopes[(row * kChannels + c) * kBatch + n] = r[row].v[c];
        }
      }
    }
  }

  void EvaluateResiduals(std::size_t b, int size, const double* z, TermBatch* to) const override {
    for (int n = 0; n < size; ++n) {
      const double outputs[kChannels] = {z[n], z[kBatch + n], z[2 * kBatch + n]};
      double r[kRows];
      functors_[b * kBatch + n](outputs, r);
      for (int row = 0; row < kRows; ++row) to->residuals[row * kBatch + n] = r[row];
    }
  }

  void AddAbsoluteGradient(const float* z, const float* cos_i, const float* f, float scale,
                           float* gradient) const override {
    for (int n = 0; n < kBatch; ++n) {
      if (cos_i[n] == 0.0f) continue;
      const Functor functor({f[n], f[kBatch + n], f[2 * kBatch + n]}, cos_i[n]);
      for (const Jet& r : Linearize(functor, z + n)) {
        for (int c = 0; c < kChannels; ++c) {
          gradient[c * kBatch + n] += static_cast<float>(scale / kRows * Sign(r.a) * r.v[c]);
        }
      }
    }
  }

  ceres::CostFunction* NewCostFunction(const NetworkShape& shape,
                                       const BrdfSample& sample) const override {
    return NewAutodiffCostFunction(shape, {Encode(shape.encoding(), sample.pair)},
                                   Functor(sample.value, CosI(sample.pair)));
  }

 private:
  using Jet = ceres::Jet<double, kChannels>;

  // z: the outputs of one sample, kBatch apart.
  template <typename T>
  static std::array<Jet, kRows> Linearize(const Functor& functor, const T* z) {
    static_assert(kChannels == 3);
    const Jet outputs[kChannels] = {Jet(z[0], 0), Jet(z[kBatch], 1), Jet(z[2 * kBatch], 2)};
    std::array<Jet, kRows> r;
    functor(outputs, r.data());
    return r;
  }

  std::vector<Functor> functors_;  // one a sample
};

}  // namespace pbnbrdf
