#include "torch_module_text.h"

#include "base/text.h"
#include "export/code.h"
#include "export/formats.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr Language kTorch = {
    .statement = "    $ = $\n",
    .component = {"_x", "_y", "_z"},
    .single_precision = false,
    .functions = {"_maximum($, $)", "_minimum($, $)", "torch.atan2($, $)", "torch.sqrt($)",
                  "torch.log($)", "torch.floor($)", "torch.tanh($)", "torch.expm1($)",
                  "_where($ > $, $, $)"}};

// [[[w, ..., b], ...], ...]: of each layer [W | b].
std::string WeightsText(const NeuralBrdf& network) {
  std::vector<std::string> layers;
  for (const LayerWeights& layer : network.Layers()) {
    std::vector<std::string> rows;
    for (int o = 0; o < layer.out; ++o) {
      std::vector<std::string> numbers;
      for (int i = 0; i <= layer.in; ++i) numbers.push_back(Literal(layer.weight(o, i)));
      rows.push_back(StrCat("[", Join(numbers, ", "), "]"));
    }
    layers.push_back(StrCat("[", Join(rows, ",\n  "), "]"));
  }
  return StrCat("[\n  ", Join(layers, ",\n\n  "), "]\n");
}

}  // namespace

std::string TorchModule(const NeuralBrdf& fitted, const std::string& name) {
  CheckIdentifier(name);
  const NeuralBrdf network = fitted.WithRgbOutputs();
  const NetworkShape& shape = network.shape();
  const auto [statements, inputs] = PrintInputs(kTorch, shape.encoding());
  return FillIn(
      kTorchModuleText,
      {{"about", CommentText(network)},
       {"name", name},
       {"encode", statements},
       {"inputs", Join(inputs, ", ")},
       {"activate", PrintExpression(kTorch, Activate(shape.activation(), Term::Variable("x")))},
       {"reflectance", PrintExpression(kTorch, ClampedReflectance(Term::Variable("z")))},
       {"weights", WeightsText(network)}});
}

}  // namespace pbnbrdf
