// network_shape.h: the layers of a fully connected network and where their weights lie.
//
// Layer l maps sizes[l] values to sizes[l + 1]; its weights are the matrix [W | b], row-major,
// shape out x (in + 1), bias last: one Ceres parameter block. All layers one after the other make
// up the vector of weights: a 6-21-21-3 network has blocks of 147, 462 and 66, 675 numbers.
//
// A network of one output is for materials of one channel: wherever the kChannels outputs z of a
// network are taken, its output stands for all of them, and gradients with respect to these are
// summed. Its last block is a third of the other's; nothing else differs.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {

enum class Activation {
  kTanh,  // smooth: what second-order solvers want
  kRelu,  // NBRDF's
};

inline constexpr NameTable<Activation, 2> kActivations = {
    {{"tanh", Activation::kTanh}, {"relu", Activation::kRelu}}};

class NetworkShape {
 public:
  static constexpr int kChannels = 3;  // that a Brdf has, whatever the outputs
  static constexpr int kMaxLayerSize = 256, kMaxLayers = 8;

  // hidden: sizes of the hidden layers, e.g. {21, 21}. Throws Error unless there are 1 to
  // kMaxLayers - 1 of them, each of 1 to kMaxLayerSize units, and 1 or kChannels outputs.
  NetworkShape(Encoding encoding, std::vector<int> hidden, Activation activation,
               int outputs = kChannels);

  Encoding encoding() const { return encoding_; }
  Activation activation() const { return activation_; }

  int num_layers() const { return static_cast<int>(sizes_.size()) - 1; }
  int in(int layer) const { return sizes_[layer]; }
  int out(int layer) const { return sizes_[layer + 1]; }
  int block_size(int layer) const { return out(layer) * (in(layer) + 1); }
  int offset(int layer) const { return offsets_[layer]; }  // of its block in the weights
  int num_weights() const { return offsets_.back(); }
  int num_outputs() const { return sizes_.back(); }
  std::vector<int> hidden() const { return {sizes_.begin() + 1, sizes_.end() - 1}; }

  // Pointers to each layer's block within `weights`, num_weights() numbers.
  template <typename T>
  std::vector<T*> Blocks(T* weights) const {
    std::vector<T*> blocks;
    for (int layer = 0; layer < num_layers(); ++layer) blocks.push_back(weights + offset(layer));
    return blocks;
  }

  // "6-21-21-3 tanh"
  std::string Description() const;

 private:
  Encoding encoding_;
  Activation activation_;
  std::vector<int> sizes_;
  std::vector<int> offsets_;
};

}  // namespace pbnbrdf
