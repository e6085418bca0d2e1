// network_enclosure.h: what can be said of a network's values and derivatives all over boxes, many boxes at a time.
//
// A quantity is known as its value at the box's centre, how far it is from that at most (its radius), and for each
// variable an interval of its derivative, as middle and radius. Products with a layer's weights W then are products
// with W (centres, middles) and with |W| (radii): the kernels' own. A radius is the smaller one of what the radii of
// the layer's inputs give and of what the derivatives give: the first is the smaller one in large boxes, the second
// in small ones, as it knows that inputs depend on each other.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/aligned_vector.h"
#include "kernels/kernels.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "proof/enclosure.h"

namespace pbnbrdf {

template <int D>
class NetworkEnclosure {
 public:
  static constexpr int kBoxes = kernels::kBatch;

  // Must not outlive the network.
  explicit NetworkEnclosure(const NeuralBrdf& network);

  // Sets the inputs of a box, and the box's half sides.
  void SetInputs(int box, const Inputs<Enclosure<D>>& inputs, const std::array<double, D>& radii);

  // Of all boxes.
  void Run();

  // After Run: f (1/sr) of a channel in a box.
  Enclosure<D> Reflectance(int box, int channel) const;

  // An upper bound of its mean over the first `averaged` variables, for all values of the others.
  double LargestMean(int box, int channel, int averaged) const;

 private:
  // By unit, size x kBoxes.
  struct Layer {
    explicit Layer(int size);

    int size;
    AlignedVector<double> center, radius;
    std::array<AlignedVector<double>, D> slope, slope_radius;
  };
  struct Weights {
    AlignedVector<double> with_bias, without_bias, absolute;
  };

  void Multiply(const Weights& weights, const Layer& in, Layer* out);
  void Tighten(Layer* layer) const;
  void ApplyTanh(Layer* layer) const;
  void ApplyRelu(Layer* layer) const;

  Activation activation_;
  std::vector<Weights> weights_;
  std::vector<Layer> layers_;  // the inputs, and each layer's outputs
  std::array<AlignedVector<double>, D> radii_;
};

extern template class NetworkEnclosure<3>;
extern template class NetworkEnclosure<4>;

}  // namespace pbnbrdf
