#include "pbnbrdf/sources/nbrdf_files.h"

#include <array>
#include <cmath>
#include <string_view>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/keras_archive.h"
#include "sources/keras_h5.h"
#include "sources/npy.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kFirstNpy = "fc1.npy";
constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr int kNpyLayers = 3;

// A tensor and how messages name it.
struct Named {
  std::string place;
  Tensor tensor;
};

struct Layer {
  Named kernel, bias;  // in x out; out
};

bool IsHdf5(const std::string& path) {
  const std::string name = LowerCase(path);
  return name.ends_with(".h5") || name.ends_with(".hdf5");
}

bool IsKeras(const std::string& path) {
  return IsHdf5(path) || LowerCase(path).ends_with(".keras");
}

bool LooksLikeKeras(std::string_view start) {
  return start.starts_with(kHdf5Magic) || start.starts_with(kZipMagic);
}

std::vector<Layer> ReadKerasLayers(const std::string& path) {
  std::vector<Layer> layers;
  for (KerasDenseLayer& layer : ReadKerasDenseLayers(path)) {
    const std::string group = StrCat(path, ": dataset ", layer.name, "/");
    layers.push_back({{group + layer.kernel_name, std::move(layer.kernel)},
                      {group + layer.bias_name, std::move(layer.bias)}});
  }
  return layers;
}

struct NpyLayerNames {
  std::string kernel, bias;
};

// From that of the first layer's kernel.
std::array<NpyLayerNames, kNpyLayers> NpyNames(const std::string& path) {
  const std::string base = path.substr(0, path.size() - kFirstNpy.size());
  std::array<NpyLayerNames, kNpyLayers> names;
  for (int k = 1; k <= kNpyLayers; ++k) {
    names[k - 1] = {StrCat(base, "fc", k, ".npy"), StrCat(base, "b", k, ".npy")};
  }
  return names;
}

std::vector<Layer> ReadNpyLayers(const std::string& path) {
  if (!path.ends_with(kFirstNpy)) {
    Fail(path, ": name the first layer's file, ...", kFirstNpy,
         "; fc2, fc3, b1, b2 and b3 are read from beside it");
  }
  std::vector<Layer> layers;
  for (const auto& [kernel, bias] : NpyNames(path)) {
    layers.push_back({{kernel, ReadNpy(kernel)}, {bias, ReadNpy(bias)}});
  }
  return layers;
}

void CheckFinite(const Named& named) {
  for (double value : named.tensor.values) {
    if (!std::isfinite(value)) {
      Fail(named.place, ": holds a value that is not finite; the file or its training is damaged");
    }
  }
}

// Throws Error unless the layer maps `in` values to some number that its bias agrees with, and the
// last one to three.
void CheckLayer(const Layer& layer, std::int64_t in, bool last) {
  const auto& kernel = layer.kernel.tensor.shape;
  const auto& bias = layer.bias.tensor.shape;
  if (kernel.size() != 2 || kernel[0] != in || (last && kernel[1] != NetworkShape::kChannels)) {
    Fail(layer.kernel.place, ": shape ", ShapeText(kernel), ", expected ", in, " x ",
         last ? "3, the last layer's" : "units", "; kernels are inputs x outputs");
  }
  if (bias.size() != 1 || bias[0] != kernel[1]) {
    Fail(layer.bias.place, ": shape ", ShapeText(bias), ", expected ", kernel[1],
         ", the outputs of its layer's kernel");
  }
  CheckFinite(layer.kernel);
  CheckFinite(layer.bias);
}

// The layers' sizes but the last. Throws Error.
std::vector<int> HiddenSizes(const std::vector<Layer>& layers) {
  std::vector<int> sizes;
  std::int64_t in = kEncodedSize;
  for (const Layer& layer : layers) {
    CheckLayer(layer, in, /*last=*/&layer == &layers.back());
    in = layer.kernel.tensor.shape[1];
    sizes.push_back(static_cast<int>(in));
  }
  sizes.pop_back();
  return sizes;
}

// [W | b] of a layer, appended: W is the kernel's transpose.
void AppendBlock(const Layer& layer, std::vector<double>* weights) {
  const Tensor& kernel = layer.kernel.tensor;
  const std::int64_t in = kernel.shape[0], out = kernel.shape[1];
  for (std::int64_t o = 0; o < out; ++o) {
    for (std::int64_t i = 0; i < in; ++i) weights->push_back(kernel.values[i * out + o]);
    weights->push_back(layer.bias.tensor.values[o]);
  }
}

// The reverse of AppendBlock, for all layers.
std::vector<KerasDenseLayer> DenseLayers(const NeuralBrdf& network) {
  std::vector<KerasDenseLayer> layers;
  for (const LayerWeights& from : network.Layers()) {
    KerasDenseLayer& layer = layers.emplace_back();
    layer = {StrCat("dense_", layers.size()), {{from.in, from.out}, {}}, {{from.out}, {}}};
    for (int i = 0; i < from.in; ++i) {
      for (int o = 0; o < from.out; ++o) layer.kernel.values.push_back(from.weight(o, i));
    }
    for (int o = 0; o < from.out; ++o) layer.bias.values.push_back(from.bias(o));
  }
  return layers;
}

void CheckIsNbrdf(const NeuralBrdf& network) {
  const NetworkShape& shape = network.shape();
  if (shape.encoding() != Encoding::kCartesian || shape.activation() != Activation::kRelu) {
    Fail("an NBRDF network has relu units and the cartesian encoding, this one is ",
         NameOf(kActivations, shape.activation()), ", ", NameOf(kEncodings, shape.encoding()),
         "; fit with --encoding=cartesian --activation=relu");
  }
  for (double weight : network.weights()) {
    if (!std::isfinite(static_cast<float>(weight))) Fail("weight ", weight, " is beyond float32");
  }
}

}  // namespace

bool IsNbrdfFile(const std::string& path) {
  return IsKeras(path) || LowerCase(path).ends_with(".npy");
}

bool LooksLikeNbrdf(std::string_view start) {
  return LooksLikeKeras(start) || start.starts_with(kNpyMagic);
}

NeuralBrdf ReadNbrdf(const std::string& path) {
  const bool keras = IsKeras(path) || LooksLikeKeras(ReadStart(path, kHdf5Magic.size()));
  const std::vector<Layer> layers = keras ? ReadKerasLayers(path) : ReadNpyLayers(path);
  std::vector<int> hidden = HiddenSizes(layers);
  std::vector<double> weights;
  for (const Layer& layer : layers) AppendBlock(layer, &weights);
  try {
    const NetworkShape shape(Encoding::kCartesian, std::move(hidden), Activation::kRelu);
    return NeuralBrdf(shape, std::move(weights),
                      {{"origin", keras ? "NBRDF, Keras file" : "NBRDF, NumPy files"}});
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
}

std::vector<FileContent> NbrdfFiles(const NeuralBrdf& network, const std::string& path) {
  CheckIsNbrdf(network);
  const std::vector<KerasDenseLayer> layers = DenseLayers(network.WithRgbOutputs());
  if (IsHdf5(path)) return {{path, KerasH5Bytes(layers)}};
  if (!path.ends_with(kFirstNpy)) {
    Fail(path, ": name the first layer's file, ...", kFirstNpy,
         "; fc2, fc3, b1, b2 and b3 are written beside it");
  }
  if (layers.size() != kNpyLayers) {
    Fail("the NumPy files hold ", kNpyLayers, " layers, a ", network.shape().Description(),
         " network has ", layers.size());
  }
  const auto names = NpyNames(path);
  std::vector<FileContent> files;
  for (int k = 0; k < kNpyLayers; ++k) {
    files.push_back({names[k].kernel, NpyBytes(layers[k].kernel)});
    files.push_back({names[k].bias, NpyBytes(layers[k].bias)});
  }
  return files;
}

std::vector<std::string> FilesReadWith(const std::string& path) {
  if (!path.ends_with(kFirstNpy)) return {path};
  std::vector<std::string> files;
  for (const auto& [kernel, bias] : NpyNames(path)) files.insert(files.end(), {kernel, bias});
  return files;
}

}  // namespace pbnbrdf
