#include "lpips_weights.h"

#include <utility>

#include "network/safetensors.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf::cli {
namespace {

// What the package calls the convolutions: AlexNet's, cut into slices.
constexpr std::array<const char*, kLpipsLayers.size()> kConvolutions = {
    "net.slice1.0", "net.slice2.3", "net.slice3.6", "net.slice4.8", "net.slice5.10"};

// The tensor's values, which it loses.
std::vector<double> Take(const std::string& path, const std::string& name,
                         const std::vector<std::int64_t>& shape, SafetensorsFile* file) {
  const auto found = file->tensors.find(name);
  if (found == file->tensors.end()) {
    Fail(
        path, ": no tensor ", name, " (", ShapeText(shape),
        "): not the weights of LPIPS with AlexNet; 'pbnbrdf compare --help' says how to make them");
  }
  if (found->second.shape != shape) {
    Fail(path, ": tensor ", name, ": shape ", ShapeText(found->second.shape), ", expected ",
         ShapeText(shape));
  }
  return std::move(found->second.values);
}

}  // namespace

LpipsWeights ReadLpipsWeights(const std::string& path) {
  SafetensorsFile file = ReadSafetensors(path);
  LpipsWeights weights;
  for (std::size_t k = 0; k < kLpipsLayers.size(); ++k) {
    const LpipsLayerShape& shape = kLpipsLayers[k];
    const std::string name = kConvolutions[k];
    weights[k].kernels = Take(path, name + ".weight",
                              {shape.units, shape.inputs, shape.kernel, shape.kernel}, &file);
    weights[k].biases = Take(path, name + ".bias", {shape.units}, &file);
    weights[k].head =
        Take(path, StrCat("lin", k, ".model.1.weight"), {1, shape.units, 1, 1}, &file);
  }
  return weights;
}

}  // namespace pbnbrdf::cli
