// fast_neural_brdf.h: a fitted network evaluated in single precision, for those who need many values.
#pragma once

#include "base/aligned_vector.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// The same network as a NeuralBrdf, encoded and passed through in single precision, several pairs to
// an instruction: about 1e-5 f + 1e-6 apart from its value f, with the merl encoding up to
// 1e-4 (1 + f). Networks that are exactly reciprocal in double precision are so here.
class FastNeuralBrdf final : public Brdf {
 public:
  // Weights beyond the range of float become infinite, which makes the value 0 or the largest.
  explicit FastNeuralBrdf(const NeuralBrdf& network);

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;
  bool IsIsotropic() const override { return pbnbrdf::IsIsotropic(shape_.encoding()); }
  bool IsReciprocal() const override { return pbnbrdf::IsReciprocal(shape_.encoding()); }
  int NumChannels() const override { return shape_.num_outputs(); }
  std::string Description() const override;

 private:
  NetworkShape shape_;
  AlignedVector<float> weights_;
  std::string description_;
};

}  // namespace pbnbrdf
