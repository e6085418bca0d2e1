#include "base/text.h"
#include "export/code.h"
#include "export/formats.h"
#include "kernels/minimax.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kSource = R"(// @about@.
// Written by pbnbrdf.
//
//   vec3 @name@_eval(vec3 wi, vec3 wo);
//
// wi points to the light, wo to the viewer: unit vectors, normal +z. The value is linear RGB in
// 1/sr, without the cosine; 0 where a direction isn't above the horizon. GLSL ES 3.00 or later.
// Sets the default precision to highp, also for what follows in the shader.
precision highp float;
precision highp int;

// exp(x) - 1 for 0 <= x < 88: 2^n (1 + expm1(r)) - 1 with x = n log 2 + r.
float @name@_expm1(float x) {
  float n = floor(x * @per_log2@ + 0.5), r = x - n * @log2_high@ - n * @log2_low@;
  float p = r + r * r * (@expm1_polynomial@);
  float scale = intBitsToFloat((int(n) + 127) << 23);
  return scale * p + (scale - 1.0);
}

// From expm1(2 |x|), without cancellation.
float @name@_tanh(float x) {
  float e = @name@_expm1(2.0 * min(abs(x), 10.0)), t = e / (e + 2.0);
  return x < 0.0 ? -t : t;
}

// log(x), x > 0: x = 2^n m with m from sqrt(1/2) to sqrt(2), log m as an odd series in (m-1)/(m+1).
float @name@_log(float x) {
  int bits = floatBitsToInt(x), n = (bits - 0x3f3504f3) >> 23;
  float m = intBitsToFloat(bits - (n << 23));
  float s = (m - 1.0) / (m + 1.0), q = s * s;
  float series = 2.0 + q * (0.666666667 + q * (0.4 + q * (0.285714286 + q * 0.222222222)));
  return float(n) * @log2_high@ + (s * series + float(n) * @log2_low@);
}

// The angle in [0, pi/2] of a sine and a cosine: 2 atan(t), t the tangent of its half.
float @name@_angle(float sine, float cosine) {
  float t = sine / (1.0 + cosine), q = t * t;
  return t * (@two_atan_polynomial@);
}

// The six inputs of the network. Exchanging wi and wo only changes the signs of dx and dy.
void @name@_encode(vec3 wi, vec3 wo, out vec4 x0, out vec4 x1) {
@encode@}

float @name@_activate(float x) { return @activate@; }
vec4 @name@_activate(vec4 x) {
  return vec4(@name@_activate(x.x), @name@_activate(x.y),
              @name@_activate(x.z), @name@_activate(x.w));
}

float @name@_reflectance(float z) { return @reflectance@; }

@constants@
vec3 @name@_eval(vec3 wi, vec3 wo) {
  if (!(wi.z > 0.0 && wo.z > 0.0)) return vec3(0.0);
  vec4 x0[2];
  @name@_encode(wi, wo, x0[0], x0[1]);
@layers@  return vec3(@name@_reflectance(z.x), @name@_reflectance(z.y), @name@_reflectance(z.z));
}
)";

constexpr Language kGlsl = {
    .statement = "  float $ = $;\n",
    .component = {".x", ".y", ".z"},
    .single_precision = true,
    .functions = {"max($, $)", "min($, $)", "@name@_angle($, $)", "sqrt($)", "@name@_log($)",
                  "floor($)", "@name@_tanh($)", "@name@_expm1($)", "$ > $ ? $ : $"}};

// c0 + x * (c1 + x * (...))
template <std::size_t kSize>
std::string Polynomial(const float (&coefficients)[kSize], const std::string& x) {
  std::string text = Literal(coefficients[kSize - 1]);
  for (std::size_t i = kSize - 1; i-- > 0;) {
    text = StrCat(Literal(coefficients[i]), " + ", x, " * (", text, ")");
  }
  return text;
}

std::string EncodeBody(Encoding encoding) {
  const auto [statements, x] = PrintInputs(kGlsl, encoding);
  return StrCat(statements, "  x0 = vec4(", Join({x.begin(), x.begin() + 4}, ", "), ");\n",
                "  x1 = vec4(", x[4], ", ", x[5], ", 0.0, 0.0);\n");
}

int Quads(int count) { return (count + 3) / 4; }

// Four numbers: the weights of the units from `row` for input `column`, or their biases in column `in`; 0
// where there is no unit or input.
std::string Column(const LayerWeights& layer, int row, int column) {
  std::vector<std::string> numbers;
  for (int i = row; i < row + 4; ++i) {
    const bool exists = i < layer.out && column <= layer.in;
    numbers.push_back(exists ? Literal(SinglePrecision(layer.weight(i, column))) : "0.0");
  }
  return Join(numbers, ", ");
}

// "mat4(...)", what takes the four values from `column` to the four units; column by column.
std::string Matrix(const LayerWeights& layer, int row, int column) {
  std::vector<std::string> columns;
  for (int j = column; j < column + 4; ++j) {
    columns.push_back(Column(layer, row, j < layer.in ? j : layer.in + 1));
  }
  return StrCat("mat4(", Join(columns, ", "), ")");
}

// The weights of a layer as constants, row of units by row of units: for each four units their biases, and the
// matrices that take four values each to them.
std::string Constants(const LayerWeights& layer, int l) {
  const int outs = Quads(layer.out), ins = Quads(layer.in);
  std::vector<std::string> biases, matrices;
  for (int o = 0; o < outs; ++o) {
    biases.push_back(StrCat("vec4(", Column(layer, 4 * o, layer.in), ")"));
    for (int i = 0; i < ins; ++i) matrices.push_back(Matrix(layer, 4 * o, 4 * i));
  }
  const auto array = [&](const char* type, const char* name,
                         const std::vector<std::string>& values) {
    return StrCat("const ", type, " @name@_", name, l, "[", values.size(), "] = ", type, "[](\n  ",
                  Join(values, ",\n  "), ");\n");
  };
  return array("vec4", "b", biases) + array("mat4", "w", matrices);
}

// x<l+1> from x<l>, or z from the last ones.
std::string Pass(const LayerWeights& layer, int l) {
  const int outs = Quads(layer.out), ins = Quads(layer.in);
  const std::string sum = StrCat("@name@_b", l, "[o]"), x = StrCat("x", l);
  if (!layer.hidden) {
    return StrCat("  vec4 z = @name@_b", l, "[0];\n  for (int i = 0; i < ", ins,
                  "; ++i) z += @name@_w", l, "[i] * ", x, "[i];\n");
  }
  return StrCat("  vec4 x", l + 1, "[", outs, "];\n  for (int o = 0; o < ", outs,
                "; ++o) {\n    vec4 z = ", sum, ";\n    for (int i = 0; i < ", ins,
                "; ++i) z += @name@_w", l, "[", ins, " * o + i] * ", x, "[i];\n    x", l + 1,
                "[o] = @name@_activate(z);\n  }\n");
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
  std::string constants, layers;
  int number = 0;
  for (const LayerWeights& layer : network.Layers()) {
    constants += Constants(layer, number);
    layers += Pass(layer, number++);
  }
  const NetworkShape& shape = network.shape();
  const std::string text = FillIn(
      kSource,
      {{"per_log2", Literal(kernels::kPerLog2)},
       {"log2_high", Literal(kernels::kLog2High)},
       {"log2_low", Literal(kernels::kLog2Low)},
       {"expm1_polynomial", Polynomial(kernels::kExpm1Polynomial, "r")},
       {"two_atan_polynomial", Polynomial(kernels::kTwoAtanPolynomial, "q")},
       {"encode", EncodeBody(shape.encoding())},
       {"activate", PrintExpression(kGlsl, Activate(shape.activation(), Term::Variable("x")))},
       {"reflectance", PrintExpression(kGlsl, ClampedReflectance(Term::Variable("z")))},
       {"constants", constants},
       {"layers", layers}});
  return FillIn(text, {{"about", CommentText(network)}, {"name", name}});
}

}  // namespace pbnbrdf
