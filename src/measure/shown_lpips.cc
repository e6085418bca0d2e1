#include "measure/shown_lpips.h"

#include <array>
#include <utility>

#include "base/about.h"
#include "base/text.h"
#include "network/safetensors.h"
#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {
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

ShownLpips::ShownLpips(const std::string& file) : file_(file) {
  SafetensorsFile tensors = ReadSafetensors(file);
  for (std::size_t k = 0; k < kLpipsLayers.size(); ++k) {
    const LpipsLayerShape& shape = kLpipsLayers[k];
    const std::string name = kConvolutions[k];
    weights_[k].kernels = Take(file, name + ".weight",
                               {shape.units, shape.inputs, shape.kernel, shape.kernel}, &tensors);
    weights_[k].biases = Take(file, name + ".bias", {shape.units}, &tensors);
    weights_[k].head =
        Take(file, StrCat("lin", k, ".model.1.weight"), {1, shape.units, 1, 1}, &tensors);
  }
}

double ShownLpips::Of(const Image& reference, const Image& test, double exposure) const {
  const Image shown_reference = DisplayImage(reference, exposure);
  const Image shown_test = DisplayImage(test, exposure);
  return About(file_, [&] { return Lpips(shown_reference, shown_test, weights_); });
}

}  // namespace pbnbrdf
