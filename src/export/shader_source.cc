#include <array>
#include <cstdio>

#include "base/half.h"
#include "base/text.h"
#include "export/code.h"
#include "export/formats.h"
#include "kernels/minimax.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

// What shading languages write differently. Texts have @keys@, which are filled in later.
struct Dialect {
  std::string_view language;  // as the text's first lines name it
  std::string_view begin;     // before the first function
  bool types_follow_names;    // fn f(x: T) -> R, rather than R f(T x)
  std::string_view real, integer, vec3, vec4, mat4;
  std::string_view let, let_integer;  // what a local constant begins with
  std::string_view float_of_bits, bits_of_float;
  std::string_view array;      // a constant one of the program
  std::string_view variables;  // a local array of vec4
  std::string_view sum;        // a local vec4 that changes
  std::string_view counter;    // a loop over i from 0
  std::string_view product;    // of a matrix and a vector
  bool by_rows;                // of a matrix's numbers
  std::string_view uvec2;
  std::string_view halves;   // the four numbers of half precision in a uvec2, as a vec4
  std::string_view greater;  // a > b ? yes : no
};

constexpr Dialect kGlsl = {
    .language =
        "GLSL ES 3.00 or later. Sets the default precision to highp, also for what follows in the "
        "shader",
    .begin = "precision highp float;\nprecision highp int;\n",
    .types_follow_names = false,
    .real = "float",
    .integer = "int",
    .vec3 = "vec3",
    .vec4 = "vec4",
    .mat4 = "mat4",
    .let = "float",
    .let_integer = "int",
    .float_of_bits = "intBitsToFloat",
    .bits_of_float = "floatBitsToInt",
    .array = "const @type@ @name@_@array@[@count@] = @type@[](\n  @values@);\n",
    .variables = "vec4 @array@[@count@];",
    .sum = "vec4 z",
    .counter = "int @i@ = 0; @i@ < @count@; ++@i@",
    .product = "@matrix@ * @vector@",
    .by_rows = false,
    .uvec2 = "uvec2",
    .halves = "vec4(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y))",
    .greater = "$ > $ ? $ : $"};

constexpr Dialect kHlsl = {
    .language = "HLSL of shader model 5 or later, or Slang",
    .begin = "",
    .types_follow_names = false,
    .real = "float",
    .integer = "int",
    .vec3 = "float3",
    .vec4 = "float4",
    .mat4 = "float4x4",
    .let = "float",
    .let_integer = "int",
    .float_of_bits = "asfloat",
    .bits_of_float = "asint",
    .array = "static const @type@ @name@_@array@[@count@] = {\n  @values@};\n",
    .variables = "float4 @array@[@count@];",
    .sum = "float4 z",
    .counter = "int @i@ = 0; @i@ < @count@; ++@i@",
    .product = "mul(@matrix@, @vector@)",
    .by_rows = true,
    .uvec2 = "uint2",
    .halves =
        "float4(f16tof32(bits.x), f16tof32(bits.x >> 16), f16tof32(bits.y), f16tof32(bits.y >> "
        "16))",
    .greater = "$ > $ ? $ : $"};

constexpr Dialect kWgsl = {
    .language = "WGSL",
    .begin =
        "fn @name@_greater(a: f32, b: f32, yes: f32, no: f32) -> f32 { return select(no, yes, a > "
        "b); }\n",
    .types_follow_names = true,
    .real = "f32",
    .integer = "i32",
    .vec3 = "vec3<f32>",
    .vec4 = "vec4<f32>",
    .mat4 = "mat4x4<f32>",
    .let = "let",
    .let_integer = "let",
    .float_of_bits = "bitcast<f32>",
    .bits_of_float = "bitcast<i32>",
    .array = "const @name@_@array@ = array<@type@, @count@>(\n  @values@);\n",
    .variables = "var @array@: array<vec4<f32>, @count@>;",
    .sum = "var z",
    .counter = "var @i@ = 0; @i@ < @count@; @i@++",
    .product = "@matrix@ * @vector@",
    .by_rows = false,
    .uvec2 = "vec2<u32>",
    // Not .y of one call: of constants wgpu on Mesa 22.3 took it for 0.
    .halves =
        "vec4<f32>(unpack2x16float(bits.x).x, unpack2x16float(bits.x >> 16u).x, "
        "unpack2x16float(bits.y).x, unpack2x16float(bits.y >> 16u).x)",
    .greater = "@name@_greater($, $, $, $)"};

constexpr std::string_view kSource = R"(// @about@.
// Written by pbnbrdf, in @language@.
//
//   @declaration@
//
// wi points to the light, wo to the viewer: unit vectors, normal +z. The value is linear RGB in 1/sr, without the
// cosine; 0 where a direction isn't above the horizon.
@begin@
// exp(x) - 1 for 0 <= x < 88: 2^n (1 + expm1(r)) - 1 with x = n log 2 + r.
@real:expm1:x@ {
  @let@ n = floor(x * @per_log2@ + 0.5);
  @let@ r = x - n * @log2_high@ - n * @log2_low@;
  @let@ p = r + r * r * (@expm1_polynomial@);
  @let@ scale = @float_of_bits@((@integer@(n) + 127) << 23u);
  return scale * p + (scale - 1.0);
}

// Error below 4e-7.
@real:tanh:x@ {
  @let@ q = min(x * x, @tanh_most@);
  @let@ ratio = x * (@tanh_numerator@) / (@tanh_denominator@);
  return max(-1.0, min(1.0, ratio));
}

// log(x), x > 0: x = 2^n m with m from sqrt(1/2) to sqrt(2), log m as an odd series in (m-1)/(m+1).
@real:log:x@ {
  @let_integer@ bits = @bits_of_float@(x);
  @let_integer@ n = (bits - 0x3f3504f3) >> 23u;
  @let@ m = @float_of_bits@(bits - (n << 23u));
  @let@ s = (m - 1.0) / (m + 1.0);
  @let@ q = s * s;
  @let@ series = 2.0 + q * (0.666666667 + q * (0.4 + q * (0.285714286 + q * 0.222222222)));
  return @real@(n) * @log2_high@ + (s * series + @real@(n) * @log2_low@);
}

// The angle in [0, pi/2] of a sine and a cosine: 2 atan(t), t the tangent of its half.
@real:angle:sine,cosine@ {
  @let@ t = sine / (1.0 + cosine);
  @let@ q = t * t;
  return t * (@two_atan_polynomial@);
}

@real:activate:x@ { return @activate@; }

@vec4:activate4:x@ {
  return @vec4@(@name@_activate(x.x), @name@_activate(x.y), @name@_activate(x.z), @name@_activate(x.w));
}

@real:reflectance:z@ { return @reflectance@; }

@halves@@constants@
@declaration_begin@ {
  if (!(wi.z > 0.0 && wo.z > 0.0)) { return @vec3@(0.0, 0.0, 0.0); }
  // The six inputs of the network. Exchanging wi and wo only changes the signs of dx and dy.
@encode@@layers@  return @vec3@(@name@_reflectance(z.x), @name@_reflectance(z.y), @name@_reflectance(z.z));
}
)";

// c0 + x * (c1 + x * (...))
template <std::size_t kSize>
std::string Polynomial(const float (&coefficients)[kSize], const std::string& x) {
  std::string text = Literal(coefficients[kSize - 1]);
  for (std::size_t i = kSize - 1; i-- > 0;) {
    text = StrCat(Literal(coefficients[i]), " + ", x, " * (", text, ")");
  }
  return text;
}

// How terms are printed: names of functions are the same in all three languages.
Language LanguageOf(const Dialect& dialect, const std::string& statement) {
  return {.statement = statement,
          .component = {".x", ".y", ".z"},
          .single_precision = true,
          .functions = {"max($, $)", "min($, $)", "@name@_angle($, $)", "sqrt($)", "@name@_log($)",
                        "floor($)", "@name@_tanh($)", "@name@_expm1($)", dialect.greater}};
}

// "float NAME_f(float x)" or "fn NAME_f(x: f32) -> f32": a function of numbers or vectors of one type to one of them.
std::string Head(const Dialect& dialect, std::string_view type, const std::string& function,
                 const std::vector<std::string>& arguments, std::string_view result) {
  std::vector<std::string> typed;
  for (const std::string& argument : arguments) {
    typed.push_back(dialect.types_follow_names ? StrCat(argument, ": ", type)
                                               : StrCat(type, " ", argument));
  }
  const std::string rest = StrCat("@name@_", function, "(", Join(typed, ", "), ")");
  return dialect.types_follow_names ? StrCat("fn ", rest, " -> ", result)
                                    : StrCat(result, " ", rest);
}

// "vec4 x0[2];"
std::string Variables(const Dialect& dialect, const std::string& array, int count) {
  return StrCat("  ", FillIn(dialect.variables, {{"array", array}, {"count", StrCat(count)}}),
                "\n");
}

std::string EncodeBody(const Dialect& dialect, const Language& language, Encoding encoding) {
  const auto [statements, x] = PrintInputs(language, encoding);
  return StrCat(statements, Variables(dialect, "x0", 2), "  x0[0] = ", dialect.vec4, "(",
                Join({x.begin(), x.begin() + 4}, ", "), ");\n  x0[1] = ", dialect.vec4, "(", x[4],
                ", ", x[5], ", 0.0, 0.0);\n");
}

int Quads(int count) { return (count + 3) / 4; }

using Quad = std::array<double, 4>;

// The weight of a unit for an input, or its bias for input `in`; 0 where there is no unit or input.
double WeightOrZero(const LayerWeights& layer, int unit, int input) {
  return unit < layer.out && input <= layer.in ? layer.weight(unit, input) : 0.0;
}

// Of the four units from `unit` on.
Quad Biases(const LayerWeights& layer, int unit) {
  Quad quad;
  for (int k = 0; k < 4; ++k) quad[k] = WeightOrZero(layer, unit + k, layer.in);
  return quad;
}

// What takes the four values from `input` on to the four units from `unit` on: its rows or its columns.
std::array<Quad, 4> Matrix(const Dialect& dialect, const LayerWeights& layer, int unit, int input) {
  std::array<Quad, 4> quads;
  for (int n = 0; n < 16; ++n) {
    const int row = dialect.by_rows ? n / 4 : n % 4, column = dialect.by_rows ? n % 4 : n / 4;
    quads[n / 4][n % 4] =
        input + column < layer.in ? WeightOrZero(layer, unit + row, input + column) : 0.0;
  }
  return quads;
}

std::string Numbers(const Quad& quad) {
  std::vector<std::string> numbers;
  for (const double number : quad) numbers.push_back(Literal(SinglePrecision(number)));
  return Join(numbers, ", ");
}

// As an integer, the first number in its low half.
std::string Halves(double first, double second) {
  char text[16];
  std::snprintf(text, sizeof(text), "0x%08xu", HalfBits(first) | HalfBits(second) << 16);
  return text;
}

// The elements of an array.
std::string Element(const Dialect& dialect, WeightStorage storage, const Quad& quad) {
  if (storage == WeightStorage::kSingle) return StrCat(dialect.vec4, "(", Numbers(quad), ")");
  return StrCat(dialect.uvec2, "(", Halves(quad[0], quad[1]), ", ", Halves(quad[2], quad[3]), ")");
}

void AddElements(const Dialect& dialect, WeightStorage storage, const std::array<Quad, 4>& matrix,
                 std::vector<std::string>* elements) {
  if (storage == WeightStorage::kHalf) {
    for (const Quad& quad : matrix) elements->push_back(Element(dialect, storage, quad));
    return;
  }
  std::vector<std::string> numbers;
  for (const Quad& quad : matrix) numbers.push_back(Numbers(quad));
  elements->push_back(StrCat(dialect.mat4, "(", Join(numbers, ", "), ")"));
}

// The weights of a layer as constants, row of units by row of units: for each four units their biases, and the
// matrices that take four values each to them, of half precision as four elements each.
std::string Constants(const Dialect& dialect, WeightStorage storage, const LayerWeights& layer,
                      int l) {
  const int outs = Quads(layer.out), ins = Quads(layer.in);
  std::vector<std::string> biases, matrices;
  for (int o = 0; o < outs; ++o) {
    biases.push_back(Element(dialect, storage, Biases(layer, 4 * o)));
    for (int i = 0; i < ins; ++i) {
      AddElements(dialect, storage, Matrix(dialect, layer, 4 * o, 4 * i), &matrices);
    }
  }
  const auto array = [&](std::string_view single, const std::string& name,
                         const std::vector<std::string>& values) {
    const std::string_view type = storage == WeightStorage::kHalf ? dialect.uvec2 : single;
    return FillIn(dialect.array, {{"type", std::string(type)},
                                  {"array", name},
                                  {"count", StrCat(values.size())},
                                  {"values", Join(values, ",\n  ")}});
  };
  return array(dialect.vec4, StrCat("b", l), biases) +
         array(dialect.mat4, StrCat("w", l), matrices);
}

// The biases of the four units of row `row`.
std::string BiasesAt(WeightStorage storage, int l, const std::string& row) {
  const std::string element = StrCat("@name@_b", l, "[", row, "]");
  return storage == WeightStorage::kHalf ? StrCat("@name@_halves(", element, ")") : element;
}

std::string MatrixAt(const Dialect& dialect, WeightStorage storage, int l,
                     const std::string& index) {
  const std::string array = StrCat("@name@_w", l);
  if (storage == WeightStorage::kSingle) return StrCat(array, "[", index, "]");
  std::vector<std::string> quads;
  for (int k = 0; k < 4; ++k) {
    quads.push_back(StrCat("@name@_halves(", array, "[4 * (", index, ") + ", k, "])"));
  }
  return StrCat(dialect.mat4, "(", Join(quads, ", "), ")");
}

// "vec4 NAME_halves(uvec2 bits) { return ...; }"
std::string HalvesFunction(const Dialect& dialect) {
  return StrCat("// Four numbers of half precision.\n",
                Head(dialect, dialect.uvec2, "halves", {"bits"}, dialect.vec4), " { return ",
                dialect.halves, "; }\n\n");
}

// x<l+1> from x<l>, or z from the last ones. Loops have variables of their own: those of HLSL live on behind them.
std::string Pass(const Dialect& dialect, WeightStorage storage, const LayerWeights& layer, int l) {
  const int outs = Quads(layer.out), ins = Quads(layer.in);
  const std::string i = StrCat("i", l), o = StrCat("o", l);
  const auto loop = [&](const std::string& variable, int count) {
    return StrCat("for (", FillIn(dialect.counter, {{"i", variable}, {"count", StrCat(count)}}),
                  ") { ");
  };
  // The sum over the inputs, of the row of units at `row` of the matrices.
  const auto add = [&](const std::string& row) {
    return StrCat(loop(i, ins), "z += ",
                  FillIn(dialect.product, {{"matrix", MatrixAt(dialect, storage, l, row + i)},
                                           {"vector", StrCat("x", l, "[", i, "]")}}),
                  "; }\n");
  };
  if (!layer.hidden)
    return StrCat("  ", dialect.sum, " = ", BiasesAt(storage, l, "0"), ";\n  ", add(""));
  return StrCat(Variables(dialect, StrCat("x", l + 1), outs), "  ", loop(o, outs), "\n    ",
                dialect.sum, " = ", BiasesAt(storage, l, o), ";\n    ",
                add(StrCat(ins, " * ", o, " + ")), "    x", l + 1, "[", o,
                "] = @name@_activate4(z);\n  }\n");
}

void CheckHalfWeights(const NeuralBrdf& network) {
  for (const double weight : network.weights()) {
    if (weight == NearestHalf(weight)) continue;
    Fail("weight ", weight,
         " isn't of half precision: round the network first (solve/half_weights.h)");
  }
}

std::string Source(const Dialect& dialect, WeightStorage storage, const NeuralBrdf& fitted,
                   const std::string& name) {
  if (storage == WeightStorage::kHalf) CheckHalfWeights(fitted);
  const NeuralBrdf network = fitted.WithRgbOutputs();
  std::string constants, layers;
  int number = 0;
  for (const LayerWeights& layer : network.Layers()) {
    constants += Constants(dialect, storage, layer, number);
    layers += Pass(dialect, storage, layer, number++);
  }
  const NetworkShape& shape = network.shape();
  const std::string statement = StrCat("  ", dialect.let, " $ = $;\n");
  const Language language = LanguageOf(dialect, statement);
  const auto real = [&](const char* function, const std::vector<std::string>& arguments) {
    return Head(dialect, dialect.real, function, arguments, dialect.real);
  };
  const std::string declaration = Head(dialect, dialect.vec3, "eval", {"wi", "wo"}, dialect.vec3);
  std::string text = FillIn(
      kSource,
      {{"language", std::string(dialect.language)},
       {"begin", std::string(dialect.begin)},
       {"declaration", declaration},
       {"declaration_begin", declaration},
       {"real:expm1:x", real("expm1", {"x"})},
       {"real:tanh:x", real("tanh", {"x"})},
       {"real:log:x", real("log", {"x"})},
       {"real:angle:sine,cosine", real("angle", {"sine", "cosine"})},
       {"real:activate:x", real("activate", {"x"})},
       {"real:reflectance:z", real("reflectance", {"z"})},
       {"vec4:activate4:x", Head(dialect, dialect.vec4, "activate4", {"x"}, dialect.vec4)},
       {"real", std::string(dialect.real)},
       {"integer", std::string(dialect.integer)},
       {"vec3", std::string(dialect.vec3)},
       {"vec4", std::string(dialect.vec4)},
       {"let", std::string(dialect.let)},
       {"let_integer", std::string(dialect.let_integer)},
       {"float_of_bits", std::string(dialect.float_of_bits)},
       {"bits_of_float", std::string(dialect.bits_of_float)},
       {"per_log2", Literal(kernels::kPerLog2)},
       {"log2_high", Literal(kernels::kLog2High)},
       {"log2_low", Literal(kernels::kLog2Low)},
       {"expm1_polynomial", Polynomial(kernels::kExpm1Polynomial, "r")},
       {"tanh_most", Literal(kernels::kTanhMost * kernels::kTanhMost)},
       {"tanh_numerator", Polynomial(kernels::kTanhNumerator, "q")},
       {"tanh_denominator", Polynomial(kernels::kTanhDenominator, "q")},
       {"two_atan_polynomial", Polynomial(kernels::kTwoAtanPolynomial, "q")},
       {"encode", EncodeBody(dialect, language, shape.encoding())},
       {"activate", PrintExpression(language, Activate(shape.activation(), Term::Variable("x")))},
       {"reflectance", PrintExpression(language, ClampedReflectance(Term::Variable("z")))},
       {"halves", storage == WeightStorage::kHalf ? HalvesFunction(dialect) : ""},
       {"constants", constants},
       {"layers", layers}});
  return FillIn(text, {{"about", CommentText(network)}, {"name", name}});
}

void CheckGlslName(const std::string& name) {
  CheckIdentifier(name);
  if (name.starts_with("gl_") || name.find("__") != std::string::npos || name.ends_with("_")) {
    Fail("name=", name, " is reserved in GLSL: it begins with gl_, ends with _ or has __ in it");
  }
}

}  // namespace

std::string GlslSource(const NeuralBrdf& network, const std::string& name, WeightStorage storage) {
  CheckGlslName(name);
  return Source(kGlsl, storage, network, name);
}

std::string HlslSource(const NeuralBrdf& network, const std::string& name, WeightStorage storage) {
  CheckIdentifier(name);
  return Source(kHlsl, storage, network, name);
}

std::string WgslSource(const NeuralBrdf& network, const std::string& name, WeightStorage storage) {
  CheckIdentifier(name);
  if (name == "_" || name.starts_with("__")) {
    Fail("name=", name, " is reserved in WGSL: ", name, "_eval begins with __");
  }
  return Source(kWgsl, storage, network, name);
}

}  // namespace pbnbrdf
