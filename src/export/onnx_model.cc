#include <bit>
#include <map>

#include "export/code.h"
#include "export/formats.h"
#include "export/protobuf.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "ONNX's raw data are little-endian");

constexpr std::uint64_t kIrVersion = 8, kOpset = 17;

// Field numbers and enumerators of onnx.proto.
enum { kModelIr = 1, kModelProducer = 2, kModelDoc = 6, kModelGraph = 7, kModelOpset = 8 };
enum { kGraphNode = 1, kGraphName = 2, kGraphConstant = 5, kGraphInput = 11, kGraphOutput = 12 };
enum { kNodeInput = 1, kNodeOutput = 2, kNodeType = 4, kNodeAttribute = 5 };
enum { kAttributeName = 1, kAttributeInteger = 3, kAttributeType = 20 };
enum { kTensorDims = 1, kTensorType = 2, kTensorName = 8, kTensorRaw = 9 };
constexpr std::uint64_t kFloatType = 1, kInt64Type = 7, kIntegerAttribute = 2;

template <typename T>
ProtobufMessage TensorMessage(const std::string& name, std::uint64_t type,
                              const std::vector<std::uint64_t>& shape,
                              const std::vector<T>& values) {
  ProtobufMessage message;
  for (std::uint64_t extent : shape) message.Add(kTensorDims, extent);
  message.Add(kTensorType, type);
  message.Add(kTensorName, name);
  message.Add(kTensorRaw,
              {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  return message;
}

// ValueInfoProto of a float32 value of shape N x 3.
ProtobufMessage ValueInfo(const std::string& name) {
  ProtobufMessage rows, columns, shape, tensor_type, type, info;
  rows.Add(2, "N");
  columns.Add(1, std::uint64_t{3});
  shape.Add(1, rows);
  shape.Add(1, columns);
  tensor_type.Add(1, kFloatType);
  tensor_type.Add(2, shape);
  type.Add(1, tensor_type);
  info.Add(1, name);
  info.Add(2, type);
  return info;
}

// Builds a graph. Values are float32 tensors known by their names.
class OnnxGraph {
 public:
  using Names = std::vector<std::string>;
  using Attributes = std::vector<std::pair<std::string, std::uint64_t>>;  // integers

  // Adds an operator; returns the name of its output.
  std::string Node(const std::string& type, const Names& inputs, const Attributes& attributes = {});

  // The same value under a name of the caller's.
  std::string Rename(const std::string& value, const std::string& name) {
    AddNode("Identity", {value}, {name}, {});
    return name;
  }

  // The three columns of an N x 3 value, each N x 1.
  Names Columns(const std::string& value);

  // Constants; return their names.
  std::string Scalar(float value);
  std::string Floats(const std::vector<std::uint64_t>& shape, const std::vector<float>& values);

  // The bytes of a whole model. inputs and output: names of N x 3 values.
  std::string Model(const Names& inputs, const std::string& output, const std::string& about) const;

 private:
  std::string NewName() { return StrCat("v", names_++); }
  void AddNode(const std::string& type, const Names& inputs, const Names& outputs,
               const Attributes& attributes);

  ProtobufMessage nodes_, initializers_;  // fields of the graph
  int names_ = 0;
};

void OnnxGraph::AddNode(const std::string& type, const Names& inputs, const Names& outputs,
                        const Attributes& attributes) {
  ProtobufMessage message;
  for (const std::string& input : inputs) message.Add(kNodeInput, input);
  for (const std::string& output : outputs) message.Add(kNodeOutput, output);
  message.Add(kNodeType, type);
  for (const auto& [name, value] : attributes) {
    ProtobufMessage entry;
    entry.Add(kAttributeName, name);
    entry.Add(kAttributeInteger, value);
    entry.Add(kAttributeType, kIntegerAttribute);
    message.Add(kNodeAttribute, entry);
  }
  nodes_.Add(kGraphNode, message);
}

std::string OnnxGraph::Node(const std::string& type, const Names& inputs,
                            const Attributes& attributes) {
  const std::string output = NewName();
  AddNode(type, inputs, {output}, attributes);
  return output;
}

OnnxGraph::Names OnnxGraph::Columns(const std::string& value) {
  const std::string sizes = NewName();
  initializers_.Add(kGraphConstant, TensorMessage<std::int64_t>(sizes, kInt64Type, {3}, {1, 1, 1}));
  const Names columns = {NewName(), NewName(), NewName()};
  AddNode("Split", {value, sizes}, columns, {{"axis", 1}});
  return columns;
}

std::string OnnxGraph::Scalar(float value) { return Floats({}, {value}); }

std::string OnnxGraph::Floats(const std::vector<std::uint64_t>& shape,
                              const std::vector<float>& values) {
  const std::string name = NewName();
  initializers_.Add(kGraphConstant, TensorMessage(name, kFloatType, shape, values));
  return name;
}

std::string OnnxGraph::Model(const Names& inputs, const std::string& output,
                             const std::string& about) const {
  ProtobufMessage name_and_values;
  name_and_values.Add(kGraphName, "pbnbrdf");
  for (const std::string& input : inputs) name_and_values.Add(kGraphInput, ValueInfo(input));
  name_and_values.Add(kGraphOutput, ValueInfo(output));
  std::string bytes(nodes_.bytes());
  bytes += initializers_.bytes();
  bytes += name_and_values.bytes();
  ProtobufMessage opset, result;
  opset.Add(2, kOpset);
  result.Add(kModelIr, kIrVersion);
  result.Add(kModelProducer, "pbnbrdf");
  result.Add(kModelDoc, about);
  result.Add(kModelGraph, bytes);
  result.Add(kModelOpset, opset);
  return std::string(result.bytes());
}

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
