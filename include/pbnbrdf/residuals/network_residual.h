// network_residual.h: a term as a Ceres functor of the network's weights.
//
//   // One sample, a 6-21-21-3 network of three parameter blocks:
//   using Functor = NetworkResidual<LogResidual>;
//   new ceres::AutoDiffCostFunction<Functor, 3, 147, 462, 66>(
//       new Functor(shape, {Encode(shape.encoding(), pair)}, LogResidual(f, cos_i)));
#pragma once

#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "pbnbrdf/network/encoding.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {

template <typename Term>
class NetworkResidual {
 public:
  using Input = std::array<double, kEncodedSize>;

  // inputs: encoded pairs, as many as `term` takes outputs of.
  NetworkResidual(const NetworkShape& shape, std::vector<Input> inputs, Term term)
      : shape_(shape), inputs_(std::move(inputs)), term_(std::move(term)) {}

  // For ceres::DynamicAutoDiffCostFunction. layers: a pointer to each block. False if a residual
  // isn't finite.
  template <typename T>
  bool operator()(T const* const* layers, T* residuals) const {
    using std::isfinite;
    std::vector<T> z(inputs_.size() * NetworkShape::kChannels);
    for (std::size_t m = 0; m < inputs_.size(); ++m) {
      EvaluateMlp(shape_, inputs_[m].data(), layers, &z[m * NetworkShape::kChannels]);
    }
    term_(z.data(), residuals);
    for (int r = 0; r < Term::kNumResiduals; ++r) {
      if (!isfinite(residuals[r])) return false;
    }
    return true;
  }

  // For ceres::AutoDiffCostFunction: (layer 1, layer 2, ..., residuals).
  template <typename T, typename... Rest>
  bool operator()(const T* first, const T* second, Rest... rest) const {
    const std::array<const T*, sizeof...(rest) + 2> pointers = {first, second, rest...};
    T* residuals = std::get<sizeof...(rest) - 1>(std::tie(rest...));
    return (*this)(pointers.data(), residuals);
  }

 private:
  NetworkShape shape_;
  std::vector<Input> inputs_;
  Term term_;
};

}  // namespace pbnbrdf
