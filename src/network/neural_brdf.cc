#include "pbnbrdf/network/neural_brdf.h"

#include <algorithm>
#include <cmath>

#include "base/about.h"
#include "network/batched_mlp.h"
#include "network/evaluation.h"
#include "network/safetensors.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

using kernels::kBatch;

constexpr std::string_view kOutputUnit = "expm1";

std::string WeightName(int layer) { return StrCat("fc", layer + 1, ".weight"); }
std::string BiasName(int layer) { return StrCat("fc", layer + 1, ".bias"); }

const std::string& Require(const std::string& path, const NeuralBrdf::Metadata& metadata,
                           const std::string& key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) Fail(path, ": not a fitted network: __metadata__ lacks ", key);
  return found->second;
}

const Tensor& Require(const std::string& path, const SafetensorsFile& file, const std::string& name,
                      const std::vector<std::int64_t>& shape) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) Fail(path, ": tensor ", name, " is missing");
  if (found->second.shape != shape) {
    Fail(path, ": tensor ", name, " has another shape than ", ShapeText(shape));
  }
  return found->second;
}

// The layers' sizes, from the biases fc1 ... fcL.
std::vector<int> LayerSizes(const std::string& path, const SafetensorsFile& file) {
  std::vector<int> sizes;
  for (int layer = 0; file.tensors.count(BiasName(layer)) != 0; ++layer) {
    const Tensor& bias = file.tensors.at(BiasName(layer));
    if (bias.shape.size() != 1)
      Fail(path, ": tensor ", BiasName(layer), " must have one dimension");
    sizes.push_back(static_cast<int>(bias.values.size()));
  }
  if (sizes.size() < 2)
    Fail(path, ": not a fitted network: tensors fc1.bias, fc2.bias are missing");
  return sizes;
}

NetworkShape ReadShape(const std::string& path, const SafetensorsFile& file) {
  const std::string& output = Require(path, file.metadata, "output");
  if (output != kOutputUnit) Fail(path, ": output=", output, " is not ", kOutputUnit);
  const std::string& encoding = Require(path, file.metadata, "encoding");
  const std::string& activation = Require(path, file.metadata, "activation");
  return About(path, [&] {
    std::vector<int> hidden = LayerSizes(path, file);
    const int outputs = hidden.back();
    hidden.pop_back();
    return NetworkShape(ParseName(kEncodings, "encoding", encoding), std::move(hidden),
                        ParseName(kActivations, "activation", activation), outputs);
  });
}

// What SinglePrecision gives.
class FastNeuralBrdf final : public Brdf {
 public:
  // Weights beyond the range of float become infinite, which makes the value 0 or the largest.
  explicit FastNeuralBrdf(const NeuralBrdf& network);

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;
  bool IsIsotropic() const override { return pbnbrdf::IsIsotropic(shape_.encoding()); }
  bool IsReciprocal() const override { return pbnbrdf::IsReciprocal(shape_.encoding()); }
  int NumChannels() const override { return shape_.num_outputs(); }
  std::string Description() const override { return description_; }

 private:
  NetworkShape shape_;
  AlignedVector<float> weights_;
  std::string description_;
};

FastNeuralBrdf::FastNeuralBrdf(const NeuralBrdf& network)
    : shape_(network.shape()),
      weights_(network.weights().begin(), network.weights().end()),
      description_(StrCat(network.Description(), ", single precision")) {}

void FastNeuralBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                       std::span<Rgb> values) const {
  BatchedMlp<float> mlp(shape_, /*rows=*/0);
  AlignedVector<float> inputs(shape_.in(0) * kBatch);
  const auto evaluate = [&](const DirectionPair* from, Rgb* to) {
    EncodeBatch(shape_.encoding(), from, inputs.data());
    mlp.Forward(weights_.data(), inputs.data());
    ReflectanceBatch(mlp.output(), to);
  };
  std::size_t n = 0;
  for (; n + kBatch <= pairs.size(); n += kBatch) evaluate(&pairs[n], &values[n]);
  if (n == pairs.size()) return;
  std::array<DirectionPair, kBatch> rest = {};
  std::array<Rgb, kBatch> rest_values;
  std::copy(pairs.begin() + n, pairs.end(), rest.begin());
  evaluate(rest.data(), rest_values.data());
  std::copy_n(rest_values.begin(), pairs.size() - n, values.begin() + n);
}

}  // namespace

NeuralBrdf::NeuralBrdf(const NetworkShape& shape, std::vector<double> weights, Metadata metadata)
    : shape_(shape), weights_(std::move(weights)), metadata_(std::move(metadata)) {
  if (weights_.size() != static_cast<std::size_t>(shape.num_weights())) {
    Fail("weights: ", weights_.size(), " numbers, a ", shape.Description(), " network has ",
         shape.num_weights());
  }
  for (double weight : weights_) {
    if (!std::isfinite(weight)) Fail("weights: one is not finite");
  }
  metadata_["format"] = "pbnbrdf";
  metadata_["encoding"] = NameOf(kEncodings, shape.encoding());
  metadata_["activation"] = NameOf(kActivations, shape.activation());
  metadata_["output"] = kOutputUnit;
  metadata_["units"] =
      StrCat(shape.num_outputs() == 1 ? "one channel" : "linear RGB", ", 1/sr, without the cosine");
}

NeuralBrdf NeuralBrdf::Read(const std::string& path) {
  const SafetensorsFile file = ReadSafetensors(path);
  const NetworkShape shape = ReadShape(path, file);
  if (file.tensors.size() != 2 * static_cast<std::size_t>(shape.num_layers())) {
    Fail(path, ": ", file.tensors.size(), " tensors, expected ", 2 * shape.num_layers());
  }
  std::vector<double> weights;
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    const int in = shape.in(layer), out = shape.out(layer);
    const Tensor& w = Require(path, file, WeightName(layer), {out, in});
    const Tensor& b = Require(path, file, BiasName(layer), {out});
    for (int o = 0; o < out; ++o) {
      weights.insert(weights.end(), w.values.begin() + o * in, w.values.begin() + (o + 1) * in);
      weights.push_back(b.values[o]);
    }
  }
  return NeuralBrdf(shape, std::move(weights), file.metadata);
}

std::vector<LayerWeights> NeuralBrdf::Layers() const {
  std::vector<LayerWeights> layers;
  for (int l = 0; l < shape_.num_layers(); ++l) {
    layers.push_back({shape_.in(l), shape_.out(l), /*hidden=*/l + 1 < shape_.num_layers(),
                      weights_.data() + shape_.offset(l)});
  }
  return layers;
}

std::string NeuralBrdf::Serialized() const {
  SafetensorsFile file;
  file.metadata = metadata_;
  int number = 0;
  for (const LayerWeights& layer : Layers()) {
    Tensor w = {{layer.out, layer.in}, {}}, b = {{layer.out}, {}};
    for (int o = 0; o < layer.out; ++o) {
      for (int i = 0; i < layer.in; ++i) w.values.push_back(layer.weight(o, i));
      b.values.push_back(layer.bias(o));
    }
    file.tensors[WeightName(number)] = std::move(w);
    file.tensors[BiasName(number++)] = std::move(b);
  }
  return SafetensorsBytes(file);
}

void NeuralBrdf::Write(const std::string& path) const { WriteFile(path, Serialized()); }

void NeuralBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                   std::span<Rgb> values) const {
  BatchedMlp<double> mlp(shape_, 0);
  AlignedVector<double> input(kEncodedSize * kBatch);
  for (std::size_t first = 0; first < pairs.size(); first += kBatch) {
    const int count = static_cast<int>(std::min<std::size_t>(kBatch, pairs.size() - first));
    for (int n = 0; n < count; ++n) {
      const auto encoded = Encode(shape_.encoding(), pairs[first + n]);
      for (int i = 0; i < kEncodedSize; ++i) input[i * kBatch + n] = encoded[i];
    }
    mlp.Forward(weights_.data(), input.data());
    for (int n = 0; n < count; ++n) {
      for (int c = 0; c < NetworkShape::kChannels; ++c) {
        values[first + n][c] = ClampedReflectance(mlp.output()[c * kBatch + n]);
      }
    }
  }
}

NeuralBrdf NeuralBrdf::WithRgbOutputs() const {
  if (shape_.num_outputs() != 1) return *this;
  std::vector<double> weights = weights_;
  const auto last_row = weights_.begin() + shape_.offset(shape_.num_layers() - 1);
  for (int c = 1; c < NetworkShape::kChannels; ++c) {
    weights.insert(weights.end(), last_row, weights_.end());
  }
  return NeuralBrdf({shape_.encoding(), shape_.hidden(), shape_.activation()}, std::move(weights),
                    metadata_);
}

std::unique_ptr<Brdf> NeuralBrdf::SinglePrecision() const {
  return std::make_unique<FastNeuralBrdf>(*this);
}

std::string NeuralBrdf::Description() const {
  return StrCat("neural BRDF ", shape_.Description(), ", ", NameOf(kEncodings, shape_.encoding()),
                " encoding, ", shape_.num_weights(), " weights");
}

}  // namespace pbnbrdf
