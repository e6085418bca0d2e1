#include "export/glsl_source.h"

#include "export/source_text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kHead = R"(//
//   vec3 @_eval(vec3 wi, vec3 wo);
//
// wi points to the light, wo to the viewer: unit vectors, normal +z. The value is linear RGB in
// 1/sr, without the cosine; 0 where a direction isn't above the horizon. GLSL ES 3.00 or later.
// What follows in the shader is highp too, unless it says otherwise.
precision highp float;
precision highp int;

// exp(x) - 1 for 0 <= x < 88: 2^n (1 + expm1(r)) - 1 with x = n log 2 + r.
vec4 @_expm1(vec4 x) {
  vec4 n = floor(x * 1.44269504 + 0.5);
  vec4 r = x - n * 0.693359375 + n * 2.12194440e-4;
  vec4 p = 0.0416671996 + r * (0.00836651394 + r * 0.00138825227);
  p = 0.499999982 + r * (0.166665437 + r * p);
  p = r + r * r * p;
  vec4 scale = intBitsToFloat((ivec4(n) + 127) << 23);
  return scale * p + (scale - 1.0);
}
)";

// The smaller of the two halves of tanh is what expm1 gives without cancellation.
constexpr std::string_view kTanh = R"(
vec4 @_activate(vec4 x) {
  vec4 e = @_expm1(2.0 * min(abs(x), 10.0));
  vec4 t = e / (e + 2.0);
  return vec4(x.x < 0.0 ? -t.x : t.x, x.y < 0.0 ? -t.y : t.y,
              x.z < 0.0 ? -t.z : t.z, x.w < 0.0 ? -t.w : t.w);
}
)";

constexpr std::string_view kRelu = R"(
vec4 @_activate(vec4 x) { return max(x, 0.0); }
)";

constexpr std::string_view kElementary = R"(
// The angle in [0, pi/2] whose half has the tangent t.
float @_angle(float t) {
  float q = t * t;
  float p = 0.0860787358 + q * (-0.0325660162 + q * 0.0058071051);
  p = -0.284142672 + q * (0.213093548 + q * (-0.150673521 + q * p));
  return t * (1.999999972 + q * (-0.66666188 + q * (0.399861058 + q * p)));
}

// log(x), x > 0: x = 2^n m with m from sqrt(1/2) to sqrt(2), log m as an odd series in (m-1)/(m+1).
float @_log(float x) {
  int bits = floatBitsToInt(x);
  int n = ((bits - 0x3f3504f3) >> 23);
  float m = intBitsToFloat(bits - (n << 23));
  float s = (m - 1.0) / (m + 1.0), q = s * s;
  float series = 2.0 + q * (0.666666667 + q * (0.4 + q * (0.285714286 + q * 0.222222222)));
  return float(n) * 0.693359375 + (s * series - float(n) * 2.12194440e-4);
}
)";

// Half vector and difference vector d in its frame, as brdf/half_diff.h.
constexpr std::string_view kHalfDiff = R"(
// The six inputs of the network. Exchanging wi and wo changes but the signs of dx and dy.
void @_encode(vec3 wi, vec3 wo, out vec4 x0, out vec4 x1) {
  vec3 sum = wi + wo, halves = 0.5 * (wi - wo);
  float tangential2 = sum.x * sum.x + sum.y * sum.y;
  float size = sqrt(tangential2 + sum.z * sum.z), tangential = sqrt(tangential2);
  bool pole = !(tangential2 > 1e-36);
  float cos_phi = pole ? 1.0 : sum.x / tangential, sin_phi = pole ? 0.0 : sum.y / tangential;
  float sin_h = pole ? 0.0 : tangential / size, cos_h = sum.z / size;
  float radial = halves.x * cos_phi + halves.y * sin_phi;
  float dx = radial * cos_h - halves.z * sin_h;
  float dy = halves.y * cos_phi - halves.x * sin_phi;
  float dz = 0.5 * size;
)";

constexpr std::string_view kThetaH =
    R"(  float theta_h = pole ? 0.0 : @_angle(tangential / (size + sum.z));
  float root = sqrt(theta_h * 0.636619772);
  float log_h = @_log(theta_h + 1e-3) * 0.333333333;
)";

constexpr std::string_view kRowBend = R"(  float row = 90.0 * root, u = row - floor(row);
  float bend = 4.0 * u * (1.0 - u);
)";

constexpr std::string_view kCartesian = R"(  x0 = vec4(sin_h, 0.0, cos_h, dx);
  x1 = vec4(dy, dz, 0.0, 0.0);
}
)";

constexpr std::string_view kReciprocal = R"(  float s2 = dx * dx + dy * dy;
  float per_s = s2 > 1e-36 ? 1.0 / sqrt(s2) : 0.0;
  x0 = vec4(sin_h, 0.0, cos_h, (dx * dx - dy * dy) * per_s);
  x1 = vec4(2.0 * dx * dy * per_s, dz, 0.0, 0.0);
}
)";

constexpr std::string_view kMultiscale = R"(  x0 = vec4(sin_h, root, log_h, dx * dx - dy * dy);
  x1 = vec4(2.0 * dx * dy, dz, 0.0, 0.0);
}
)";

constexpr std::string_view kMerl = R"(  x0 = vec4(bend, root, log_h, dx * dx - dy * dy);
  x1 = vec4(2.0 * dx * dy, dz, 0.0, 0.0);
}
)";

constexpr std::string_view kBilateral = R"(  x0 = vec4(bend, root, log_h, dx * dx - dy * dy);
  x1 = vec4(sin_h, dz, 0.0, 0.0);
}
)";

constexpr std::string_view kAnisotropic = R"(  float r = root * sqrt(root);
  float tx = dx * cos_phi - dy * sin_phi, ty = dx * sin_phi + dy * cos_phi;
  x0 = vec4(r * cos_phi, r * sin_phi, log_h, tx * tx - ty * ty);
  x1 = vec4(2.0 * tx * ty, dz, 0.0, 0.0);
}
)";

constexpr std::string_view kEval = R"(
vec3 @_eval(vec3 wi, vec3 wo) {
  if (!(wi.z > 0.0 && wo.z > 0.0)) return vec3(0.0);
  vec4 x0_0, x0_1;
  @_encode(wi, wo, x0_0, x0_1);
)";

constexpr EncoderTexts kEncoderTexts = {
    .elementary = kElementary,
    .half_diff = kHalfDiff,
    .theta_h = kThetaH,
    .row_bend = kRowBend,
    .inputs = {kCartesian, kReciprocal, kMultiscale, kMerl, kBilateral, kAnisotropic}};

int Quads(int count) { return (count + 3) / 4; }

// One layer's weights, padded with zeros to whole vectors of four.
class LayerText {
 public:
  LayerText(const NeuralBrdf& network, int layer)
      : in_(network.shape().in(layer)),
        out_(network.shape().out(layer)),
        block_(network.weights().data() + network.shape().offset(layer)) {}

  // "vec4(...)", the biases of the four units from `row`.
  std::string Bias(int row) const {
    return StrCat("vec4(", Weight(row, in_), ", ", Weight(row + 1, in_), ", ", Weight(row + 2, in_),
                  ", ", Weight(row + 3, in_), ")");
  }

  // "mat4(...)", what takes the four values from `column` to the four units; column by column.
  std::string Matrix(int row, int column) const {
    std::string text;
    for (int j = column; j < column + 4; ++j) {
      for (int i = row; i < row + 4; ++i) {
        text += (text.empty() ? "" : ", ") + (j < in_ ? Weight(i, j) : "0.0");
      }
    }
    return "mat4(" + text + ")";
  }

 private:
  std::string Weight(int row, int column) const {
    return row < out_ ? Literal(SinglePrecision(block_[row * (in_ + 1) + column])) : "0.0";
  }

  const int in_, out_;
  const double* block_;
};

// The vectors x<l+1>_0, x<l+1>_1, ... from x<l>_0, x<l>_1, ...
std::string Pass(const NeuralBrdf& network, int l) {
  const NetworkShape& shape = network.shape();
  const LayerText layer(network, l);
  const bool last = l + 1 == shape.num_layers();
  std::string text;
  for (int o = 0; o < Quads(shape.out(l)); ++o) {
    text += StrCat("  vec4 x", l + 1, "_", o, " = ", last ? "" : "@_activate(", layer.Bias(4 * o));
    for (int i = 0; i < Quads(shape.in(l)); ++i) {
      text += StrCat("\n      + ", layer.Matrix(4 * o, 4 * i), " * x", l, "_", i);
    }
    text += last ? ";\n" : ");\n";
  }
  return text;
}

// z that isn't positive, or no number, gives 0.
std::string Output(int layers) {
  const std::string z = StrCat("x", layers, "_0");
  std::string text = "  vec4 z = vec4(";
  for (char c : {'x', 'y', 'z'}) text += StrCat(z, ".", c, " > 0.0 ? ", z, ".", c, " : 0.0, ");
  return text + "0.0);\n  return min(@_expm1(min(z, 87.0)), 1e12).xyz;\n}\n";
}

void CheckGlslName(const std::string& name) {
  CheckIdentifier(name);
  if (name.starts_with("gl_") || name.find("__") != std::string::npos || name.ends_with("_")) {
    Fail("name=", name, " is reserved in GLSL: it begins with gl_, ends with _ or has __ in it");
  }
}

}  // namespace

std::string GlslSource(const NeuralBrdf& fitted, const std::string& name) {
  const NeuralBrdf network = fitted.WithRgbOutputs();
  CheckGlslName(name);
  const NetworkShape& shape = network.shape();
  std::string text(kHead);
  text += shape.activation() == Activation::kTanh ? kTanh : kRelu;
  text += EncoderText(shape.encoding(), kEncoderTexts);
  text += kEval;
  for (int l = 0; l < shape.num_layers(); ++l) text += Pass(network, l);
  text += Output(shape.num_layers());
  return StrCat("// ", CommentText(network), ".\n// Written by pbnbrdf.\n", WithName(text, name));
}

}  // namespace pbnbrdf
