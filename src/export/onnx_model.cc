#include "export/onnx_model.h"

#include <map>

#include "export/onnx_graph.h"
#include "export/source_text.h"
#include "export/term.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

using Kind = Term::Kind;
using Names = OnnxGraph::Names;

// Adds the operators that compute terms; variables are called as the graph's values are.
class TermWriter {
 public:
  explicit TermWriter(OnnxGraph* graph) : graph_(*graph) {}

  // The name of a term's value. All terms must live as long as the writer.
  const std::string& Write(const Term& term) {
    const auto [entry, is_new] = names_.try_emplace(&term.node());
    if (is_new) entry->second = Add(term.node());
    return entry->second;
  }

 private:
  std::string Add(const Term::Node& node) {
    // From Kind::kAdd on, where there is one.
    constexpr const char* kOperators[] = {"Add", "Sub",  "Mul", "Div",   "Max", "Min",
                                          "",    "Sqrt", "Log", "Floor", "Tanh"};
    Names x;
    for (const Term& operand : node.operands) x.push_back(Write(operand));
    switch (node.kind) {
      case Kind::kConstant:
        return graph_.Scalar(static_cast<float>(node.constant));
      case Kind::kVariable:
        return node.name;
      case Kind::kAngle:
        return Angle(x[0], x[1]);
      case Kind::kExpm1:
        return Expm1(x[0]);
      case Kind::kIfGreater:
        return graph_.Node("Where", {graph_.Node("Greater", {x[0], x[1]}), x[2], x[3]});
      default:
        return graph_.Node(kOperators[static_cast<int>(node.kind)], x);
    }
  }

  // 2 atan(t), t the tangent of half the angle.
  std::string Angle(const std::string& sine, const std::string& cosine) {
    const std::string divisor = graph_.Node("Add", {cosine, graph_.Scalar(1.0f)});
    const std::string half = graph_.Node("Atan", {graph_.Node("Div", {sine, divisor})});
    return graph_.Node("Mul", {half, graph_.Scalar(2.0f)});
  }

  // 2 sinh(x / 2) exp(x / 2), which loses no digits near 0.
  std::string Expm1(const std::string& x) {
    const std::string half = graph_.Node("Mul", {x, graph_.Scalar(0.5f)});
    const std::string sinh = graph_.Node("Sinh", {half}), exp = graph_.Node("Exp", {half});
    return graph_.Node("Mul", {graph_.Node("Mul", {sinh, exp}), graph_.Scalar(2.0f)});
  }

  OnnxGraph& graph_;
  std::map<const Term::Node*, std::string> names_;
};

// The value x W' + b of N x in values x: N x out.
std::string AddLayer(OnnxGraph* graph, const LayerWeights& layer, const std::string& x) {
  std::vector<float> w, b;
  for (int o = 0; o < layer.out; ++o) {
    for (int i = 0; i < layer.in; ++i) w.push_back(SinglePrecision(layer.weight(o, i)));
    b.push_back(SinglePrecision(layer.bias(o)));
  }
  const auto rows = static_cast<std::uint64_t>(layer.out);
  const auto columns = static_cast<std::uint64_t>(layer.in);
  return graph->Node("Gemm", {x, graph->Floats({rows, columns}, w), graph->Floats({rows}, b)},
                     {{"transB", 1}});
}

// The three components of an input of the graph, each N x 1.
std::array<Term, 3> Components(OnnxGraph* graph, const std::string& vector) {
  const Names columns = graph->Columns(vector);
  return {Term::Variable(columns[0]), Term::Variable(columns[1]), Term::Variable(columns[2])};
}

}  // namespace

std::string OnnxModel(const NeuralBrdf& fitted) {
  const NeuralBrdf network = fitted.WithRgbOutputs();
  const NetworkShape& shape = network.shape();
  OnnxGraph graph;
  const auto wi = Components(&graph, "wi"), wo = Components(&graph, "wo");
  const Term zeros = 0.0 * wi[0];  // makes N x 1 of a constant
  std::vector<Term> inputs;
  for (const Term& x : Encode(shape.encoding(), HalfDiffFromPair(wi, wo))) {
    inputs.push_back(x.node().kind == Kind::kConstant ? x + zeros : x);
  }
  Names names;
  TermWriter writer(&graph);
  for (const Term& x : inputs) names.push_back(writer.Write(x));
  std::string value = graph.Node("Concat", names, {{"axis", 1}});
  for (const LayerWeights& layer : network.Layers()) {
    const Term y = Term::Variable(AddLayer(&graph, layer, value));
    value = TermWriter(&graph).Write(layer.hidden ? Activate(shape.activation(), y) : y);
  }
  const Term f = ClampedReflectance(Term::Variable(value));
  const Term rgb = IfGreater(Min(wi[2], wo[2]), 0.0, f, 0.0);  // above the horizon
  return graph.Model({"wi", "wo"}, graph.Rename(TermWriter(&graph).Write(rgb), "rgb"),
                     "wi: to the light, wo: to the viewer; unit vectors, normal +z. rgb: linear, "
                     "1/sr, without the cosine. " +
                         CommentText(network));
}

}  // namespace pbnbrdf
