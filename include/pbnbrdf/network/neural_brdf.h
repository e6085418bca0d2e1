// neural_brdf.h: a fitted network as a Brdf, and its file.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// A layer's weights, where they lie in those of the network (network_shape.h).
struct LayerWeights {
  int in, out;
  bool hidden;
  const double* block;

  double weight(int output, int input) const { return block[output * (in + 1) + input]; }
  double bias(int output) const { return weight(output, in); }
};

// f = max(0, expm1(z)), z the network's output at the encoded pair, or its only one three times.
class NeuralBrdf final : public Brdf {
 public:
  // What a file says about a fit beyond its network: "terms", "seed", "mean_abs_log_error", ...
  using Metadata = std::map<std::string, std::string>;

  // weights: shape.num_weights(), finite, laid out as in network_shape.h. Throws Error otherwise.
  NeuralBrdf(const NetworkShape& shape, std::vector<double> weights, Metadata metadata = {});

  // A safetensors file: tensors fc1.weight (out x in), fc1.bias (out), fc2.weight, ..., F64 or F32,
  // and in __metadata__ at least "encoding", "activation" and "output" ("expm1"). Throws Error.
  static NeuralBrdf Read(const std::string& path);

  // The bytes of the file that Write writes.
  std::string Serialized() const;

  // Tensors of double precision. Throws Error.
  void Write(const std::string& path) const;

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;
  bool IsIsotropic() const override { return pbnbrdf::IsIsotropic(shape_.encoding()); }
  bool IsReciprocal() const override { return pbnbrdf::IsReciprocal(shape_.encoding()); }
  int NumChannels() const override { return shape_.num_outputs(); }
  // About 1e-5 f + 1e-6 apart from the value f, with the merl encoding up to 1e-4 (1 + f). If this is
  // reciprocal to the bit, so is that. It evaluates several pairs with one instruction.
  std::unique_ptr<Brdf> SinglePrecision() const override;
  std::string Description() const override;

  // The same f with three outputs: of one output three, for those who know RGB only.
  NeuralBrdf WithRgbOutputs() const;

  const NetworkShape& shape() const { return shape_; }
  const std::vector<double>& weights() const { return weights_; }
  std::vector<LayerWeights> Layers() const;  // to be used while the network lives
  const Metadata& metadata() const { return metadata_; }

 private:
  NetworkShape shape_;
  std::vector<double> weights_;
  Metadata metadata_;
};

}  // namespace pbnbrdf
