#include "export/onnx_model.h"

#include "export/onnx_graph.h"
#include "export/source_text.h"

namespace pbnbrdf {
namespace {

using Names = OnnxGraph::Names;

// Arithmetic by name.
class Calculator {
 public:
  explicit Calculator(OnnxGraph* graph) : graph_(*graph) {}

  std::string Add(const std::string& a, const std::string& b) { return graph_.Node("Add", {a, b}); }
  std::string Sub(const std::string& a, const std::string& b) { return graph_.Node("Sub", {a, b}); }
  std::string Mul(const std::string& a, const std::string& b) { return graph_.Node("Mul", {a, b}); }
  std::string Div(const std::string& a, const std::string& b) { return graph_.Node("Div", {a, b}); }
  std::string Sqrt(const std::string& a) { return graph_.Node("Sqrt", {a}); }
  std::string Times(const std::string& a, float b) { return Mul(a, graph_.Scalar(b)); }
  std::string Plus(const std::string& a, float b) { return Add(a, graph_.Scalar(b)); }
  std::string AtLeast(const std::string& a, float b) {
    return graph_.Node("Max", {a, graph_.Scalar(b)});
  }
  std::string AtMost(const std::string& a, float b) {
    return graph_.Node("Min", {a, graph_.Scalar(b)});
  }
  std::string IsAbove(const std::string& a, float b) {
    return graph_.Node("Greater", {a, graph_.Scalar(b)});
  }
  std::string Where(const std::string& condition, const std::string& a, float otherwise) {
    return graph_.Node("Where", {condition, a, graph_.Scalar(otherwise)});
  }

  // a b + c d, a b - c d
  std::string Sum(const std::string& a, const std::string& b, const std::string& c,
                  const std::string& d) {
    return Add(Mul(a, b), Mul(c, d));
  }
  std::string Difference(const std::string& a, const std::string& b, const std::string& c,
                         const std::string& d) {
    return Sub(Mul(a, b), Mul(c, d));
  }

  OnnxGraph& graph() { return graph_; }

 private:
  OnnxGraph& graph_;
};

// brdf/half_diff.h, each value N x 1.
struct HalfDiffNames {
  std::string sin_h, cos_h, cos_phi, sin_phi;
  std::string tan_half;  // of theta_h / 2
  std::string dx, dy, dz;
};

HalfDiffNames AddHalfDiff(Calculator* c) {
  constexpr float kSmallest = 1e-18f;  // its square is still normal
  const Names sum = c->graph().Columns(c->Add("wi", "wo"));
  const Names half = c->graph().Columns(c->Times(c->Sub("wi", "wo"), 0.5f));
  const std::string tangential2 = c->Sum(sum[0], sum[0], sum[1], sum[1]);
  const std::string tangential = c->Sqrt(tangential2);
  const std::string length = c->Sqrt(c->Add(tangential2, c->Mul(sum[2], sum[2])));
  const std::string off_pole = c->IsAbove(tangential, kSmallest);
  const std::string per_tangential = c->AtLeast(tangential, kSmallest);
  const std::string per_length = c->AtLeast(length, kSmallest);
  HalfDiffNames v;
  v.cos_phi = c->Where(off_pole, c->Div(sum[0], per_tangential), 1.0f);
  v.sin_phi = c->Where(off_pole, c->Div(sum[1], per_tangential), 0.0f);
  v.sin_h = c->Where(off_pole, c->Div(tangential, per_length), 0.0f);
  v.cos_h = c->Div(sum[2], per_length);
  v.tan_half =
      c->Where(off_pole, c->Div(tangential, c->AtLeast(c->Add(length, sum[2]), kSmallest)), 0.0f);
  const std::string radial = c->Sum(half[0], v.cos_phi, half[1], v.sin_phi);
  v.dx = c->Difference(radial, v.cos_h, half[2], v.sin_h);
  v.dy = c->Difference(half[1], v.cos_phi, half[0], v.sin_phi);
  v.dz = c->Times(length, 0.5f);
  return v;
}

// Of a vector (x, y): x^2 - y^2 and 2 x y.
std::pair<std::string, std::string> Doubled(Calculator* c, const std::string& x,
                                            const std::string& y) {
  return {c->Difference(x, x, y, y), c->Mul(c->Times(x, 2.0f), y)};
}

Names EncodeWithAngle(Calculator* c, Encoding encoding, const HalfDiffNames& v) {
  constexpr float kTwoPerPi = 0.636619772f;
  const std::string theta_h = c->Times(c->graph().Node("Atan", {v.tan_half}), 2.0f);
  const std::string root = c->Sqrt(c->Times(theta_h, kTwoPerPi));
  const std::string log = c->Times(c->graph().Node("Log", {c->Plus(theta_h, 1e-3f)}), 1.0f / 3.0f);
  if (encoding == Encoding::kAnisotropic) {
    const std::string r = c->Mul(root, c->Sqrt(root));
    const auto [x, y] = Doubled(c, c->Difference(v.dx, v.cos_phi, v.dy, v.sin_phi),
                                c->Sum(v.dx, v.sin_phi, v.dy, v.cos_phi));
    return {c->Mul(r, v.cos_phi), c->Mul(r, v.sin_phi), log, x, y, v.dz};
  }
  const auto [x, y] = Doubled(c, v.dx, v.dy);
  if (encoding == Encoding::kMultiscale) return {v.sin_h, root, log, x, y, v.dz};
  const std::string row = c->Times(root, 90.0f);
  const std::string u = c->Sub(row, c->graph().Node("Floor", {row}));
  const std::string bend = c->Mul(c->Times(u, 4.0f), c->Sub(c->graph().Scalar(1.0f), u));
  return {bend, root, log, x, encoding == Encoding::kBilateral ? v.sin_h : y, v.dz};
}

// The six inputs of the network, each N x 1.
Names Encode(Calculator* c, Encoding encoding) {
  const HalfDiffNames v = AddHalfDiff(c);
  const std::string zero = c->Times(v.dz, 0.0f);
  if (encoding == Encoding::kCartesian) return {v.sin_h, zero, v.cos_h, v.dx, v.dy, v.dz};
  if (encoding != Encoding::kReciprocal) return EncodeWithAngle(c, encoding, v);
  constexpr float kSmallest = 1e-18f;
  const auto [x, y] = Doubled(c, v.dx, v.dy);
  const std::string s = c->AtLeast(c->Sqrt(c->Sum(v.dx, v.dx, v.dy, v.dy)), kSmallest);
  return {v.sin_h, zero, v.cos_h, c->Div(x, s), c->Div(y, s), v.dz};
}

// One layer of N x in values: N x out.
std::string AddLayer(OnnxGraph* graph, const NeuralBrdf& network, int l, const std::string& from) {
  const NetworkShape& shape = network.shape();
  const int in = shape.in(l), out = shape.out(l);
  const double* weight = network.weights().data() + shape.offset(l);
  std::vector<float> w, b;
  for (int o = 0; o < out; ++o) {
    for (int i = 0; i < in; ++i) w.push_back(SinglePrecision(*weight++));
    b.push_back(SinglePrecision(*weight++));
  }
  const auto rows = static_cast<std::uint64_t>(out), columns = static_cast<std::uint64_t>(in);
  const std::string y = graph->Node(
      "Gemm", {from, graph->Floats({rows, columns}, w), graph->Floats({rows}, b)}, {{"transB", 1}});
  if (l + 1 == shape.num_layers()) return y;
  return graph->Node(shape.activation() == Activation::kTanh ? "Tanh" : "Relu", {y});
}

// max(0, expm1(z)), as 2 sinh(z/2) exp(z/2), which loses no digits near 0.
std::string AddOutput(Calculator* c, const std::string& z) {
  constexpr float kLargest = 1e12f, kLargestExponent = 60.0f;
  const std::string positive = c->Where(c->IsAbove(z, 0.0f), z, 0.0f);  // not NaN
  const std::string half = c->Times(c->AtMost(positive, kLargestExponent), 0.5f);
  const std::string f =
      c->Times(c->Mul(c->graph().Node("Sinh", {half}), c->graph().Node("Exp", {half})), 2.0f);
  const std::string wi_z = c->graph().Columns("wi")[2], wo_z = c->graph().Columns("wo")[2];
  const std::string above =
      c->graph().Node("And", {c->IsAbove(wi_z, 0.0f), c->IsAbove(wo_z, 0.0f)});
  return c->Where(above, c->AtMost(f, kLargest), 0.0f);
}

}  // namespace

std::string OnnxModel(const NeuralBrdf& fitted) {
  const NeuralBrdf network = fitted.WithRgbOutputs();
  OnnxGraph graph;
  Calculator calculator(&graph);
  const Names inputs = Encode(&calculator, network.shape().encoding());
  std::string value = graph.Node("Concat", inputs, {{"axis", 1}});
  for (int l = 0; l < network.shape().num_layers(); ++l) {
    value = AddLayer(&graph, network, l, value);
  }
  return graph.Model({"wi", "wo"}, graph.Rename(AddOutput(&calculator, value), "rgb"),
                     "wi: to the light, wo: to the viewer; unit vectors, normal +z. rgb: linear, "
                     "1/sr, without the cosine. " +
                         CommentText(network));
}

}  // namespace pbnbrdf
