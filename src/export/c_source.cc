#include <algorithm>

#include "export/code.h"
#include "export/formats.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kSource = R"(/* @about@.
   Written by pbnbrdf.

   void @name@_eval(const float wi[3], const float wo[3], float rgb[3]);

   wi points to the light, wo to the viewer: unit vectors, normal +z. rgb: linear, 1/sr, without
   the cosine; 0 where a direction isn't above the horizon. C99, needs <math.h> only. */
#ifndef @name@_PBNBRDF_H
#define @name@_PBNBRDF_H

#include <math.h>

@weights@
/* The six inputs of the network. Exchanging wi and wo only changes the signs of dx and dy. */
static inline void @name@_encode(const double wi[3], const double wo[3], double x[6]) {
@encode@}

static inline double @name@_activate(double x) { return @activate@; }

/* y = W x + b; w holds a row of W and its b after the other. Hidden units are activated. */
static inline void @name@_layer(const double *w, int in, int out, int hidden, const double *x,
                                double *y) {
  for (int o = 0; o < out; ++o, w += in + 1) {
    double sum = w[in];
    for (int i = 0; i < in; ++i) sum += w[i] * x[i];
    y[o] = hidden ? @name@_activate(sum) : sum;
  }
}

static inline double @name@_reflectance(double z) { return @reflectance@; }

static inline void @name@_eval(const float wi[3], const float wo[3], float rgb[3]) {
  const double i[3] = {wi[0], wi[1], wi[2]}, o[3] = {wo[0], wo[1], wo[2]};
  double x[@width@], y[@width@];
  if (!(i[2] > 0.0 && o[2] > 0.0)) {
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    return;
  }
  @name@_encode(i, o, x);
@layers@  for (int c = 0; c < 3; ++c) rgb[c] = (float)@name@_reflectance(@z@[c]);
}

#endif
)";

constexpr Language kC = {
    .statement = "  const double $ = $;\n",
    .component = {"[0]", "[1]", "[2]"},
    .single_precision = false,
    .functions = {"fmax($, $)", "fmin($, $)", "atan2($, $)", "sqrt($)", "log($)", "floor($)",
                  "tanh($)", "expm1($)", "$ > $ ? $ : $"}};

std::string EncodeBody(Encoding encoding) {
  Code code = PrintInputs(kC, encoding);
  for (std::size_t i = 0; i < code.values.size(); ++i) {
    code.statements += StrCat("  x[", i, "] = ", code.values[i], ";\n");
  }
  return code.statements;
}

// "static const double NAME_w1[147] = {...};", a row of [W | b] on a line or more.
std::string WeightArray(const LayerWeights& layer, const std::string& array) {
  constexpr std::size_t kColumns = 98;
  std::string text =
      StrCat("static const double ", array, "[", layer.out * (layer.in + 1), "] = {\n");
  for (int o = 0; o < layer.out; ++o) {
    std::string line = "   ";
    for (int i = 0; i <= layer.in; ++i) {
      const std::string literal = StrCat(" ", Literal(layer.weight(o, i)), ",");
      if (line.size() + literal.size() > kColumns) {
        text += line + "\n";
        line = "     ";
      }
      line += literal;
    }
    text += line + "\n";
  }
  return text + "};\n";
}

}  // namespace

std::string CSource(const NeuralBrdf& fitted, const std::string& name) {
  const NeuralBrdf network = fitted.WithRgbOutputs();
  CheckIdentifier(name);
  std::string weights, layers, from = "x", to = "y";  // values go forth and back between the two
  int width = 0, number = 0;
  for (const LayerWeights& layer : network.Layers()) {
    const std::string array = StrCat(name, "_w", ++number);
    weights += WeightArray(layer, array);
    layers += StrCat("  ", name, "_layer(", array, ", ", layer.in, ", ", layer.out, ", ",
                     layer.hidden, ", ", from, ", ", to, ");\n");
    width = std::max({width, layer.in, layer.out});
    std::swap(from, to);
  }
  const Activation activation = network.shape().activation();
  return FillIn(kSource,
                {{"about", CommentText(network)},
                 {"name", name},
                 {"weights", weights},
                 {"encode", EncodeBody(network.shape().encoding())},
                 {"activate", PrintExpression(kC, Activate(activation, Term::Variable("x")))},
                 {"reflectance", PrintExpression(kC, ClampedReflectance(Term::Variable("z")))},
                 {"width", StrCat(width)},
                 {"layers", layers},
                 {"z", from}});
}

}  // namespace pbnbrdf
