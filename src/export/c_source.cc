#include "export/c_source.h"

#include <algorithm>

#include "export/source_text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kHead = R"(
   void @_eval(const float wi[3], const float wo[3], float rgb[3]);

   wi points to the light, wo to the viewer: unit vectors, normal +z. rgb: linear, 1/sr, without
   the cosine; 0 where a direction isn't above the horizon. C99, needs <math.h> only. */
#ifndef @_PBNBRDF_H
#define @_PBNBRDF_H

#include <math.h>

)";

// Half vector and difference vector d in its frame, as brdf/half_diff.h.
constexpr std::string_view kHalfDiff = R"(
/* The six inputs of the network. Exchanging wi and wo changes but the signs of dx and dy. */
static inline void @_encode(const double wi[3], const double wo[3], double x[6]) {
  const double sum_x = wi[0] + wo[0], sum_y = wi[1] + wo[1], sum_z = wi[2] + wo[2];
  const double half_x = 0.5 * (wi[0] - wo[0]), half_y = 0.5 * (wi[1] - wo[1]);
  const double half_z = 0.5 * (wi[2] - wo[2]);
  const double tangential = sqrt(sum_x * sum_x + sum_y * sum_y);
  const double length = sqrt(sum_x * sum_x + sum_y * sum_y + sum_z * sum_z);
  const double cos_phi = tangential > 0.0 ? sum_x / tangential : 1.0;
  const double sin_phi = tangential > 0.0 ? sum_y / tangential : 0.0;
  const double sin_h = tangential / length, cos_h = sum_z / length;
  const double radial = half_x * cos_phi + half_y * sin_phi;
  const double dx = radial * cos_h - half_z * sin_h;
  const double dy = half_y * cos_phi - half_x * sin_phi;
  const double dz = 0.5 * length;
)";

constexpr std::string_view kThetaH = R"(  const double theta_h = atan2(tangential, sum_z);
  const double root = sqrt(theta_h * 0.63661977236758138);
  const double log_h = log(theta_h + 1e-3) / 3.0;
)";

constexpr std::string_view kRowBend = R"(  const double row = 90.0 * root, u = row - floor(row);
  const double bend = 4.0 * u * (1.0 - u);
)";

constexpr std::string_view kCartesian = R"(  x[0] = sin_h;
  x[1] = 0.0;
  x[2] = cos_h;
  x[3] = dx;
  x[4] = dy;
)";

constexpr std::string_view kReciprocal = R"(  const double s2 = dx * dx + dy * dy;
  const double per_s = s2 > 0.0 ? 1.0 / sqrt(s2) : 0.0;
  x[0] = sin_h;
  x[1] = 0.0;
  x[2] = cos_h;
  x[3] = (dx * dx - dy * dy) * per_s;
  x[4] = 2.0 * dx * dy * per_s;
)";

constexpr std::string_view kMultiscale = R"(  x[0] = sin_h;
  x[1] = root;
  x[2] = log_h;
  x[3] = dx * dx - dy * dy;
  x[4] = 2.0 * dx * dy;
)";

constexpr std::string_view kMerl = R"(  x[0] = bend;
  x[1] = root;
  x[2] = log_h;
  x[3] = dx * dx - dy * dy;
  x[4] = 2.0 * dx * dy;
)";

constexpr std::string_view kBilateral = R"(  x[0] = bend;
  x[1] = root;
  x[2] = log_h;
  x[3] = dx * dx - dy * dy;
  x[4] = sin_h;
)";

constexpr std::string_view kAnisotropic = R"(  const double r = root * sqrt(root);
  const double tx = dx * cos_phi - dy * sin_phi, ty = dx * sin_phi + dy * cos_phi;
  x[0] = r * cos_phi;
  x[1] = r * sin_phi;
  x[2] = log_h;
  x[3] = tx * tx - ty * ty;
  x[4] = 2.0 * tx * ty;
)";

constexpr std::string_view kLayer = R"(  x[5] = dz;
}

/* y = W x + b; w holds a row of W and its b after the other. */
static inline void @_layer(const double *w, int in, int out, const double *x, double *y) {
  for (int o = 0; o < out; ++o) {
    double sum = w[in];
    for (int i = 0; i < in; ++i) sum += w[i] * x[i];
    y[o] = sum;
    w += in + 1;
  }
}

static inline void @_activate(double *y, int count) {
  for (int i = 0; i < count; ++i) y[i] = )";

constexpr std::string_view kEval = R"(;
}

static inline void @_eval(const float wi[3], const float wo[3], float rgb[3]) {
  const double i[3] = {wi[0], wi[1], wi[2]}, o[3] = {wo[0], wo[1], wo[2]};
)";

constexpr std::string_view kOutput = R"(  for (int c = 0; c < 3; ++c) {
    const double f = expm1(z[c]);
    rgb[c] = (float)(f > 0.0 ? (f < 1e12 ? f : 1e12) : 0.0);
  }
}

#endif
)";

constexpr EncoderTexts kEncoderTexts = {
    .elementary = "",
    .half_diff = kHalfDiff,
    .theta_h = kThetaH,
    .row_bend = kRowBend,
    .inputs = {kCartesian, kReciprocal, kMultiscale, kMerl, kBilateral, kAnisotropic}};

// "static const double @_w1[147] = {...};", a row of [W | b] on a line or more.
std::string WeightArray(const NeuralBrdf& network, int layer) {
  constexpr std::size_t kColumns = 98;
  const NetworkShape& shape = network.shape();
  const double* weight = network.weights().data() + shape.offset(layer);
  std::string text =
      StrCat("static const double @_w", layer + 1, "[", shape.block_size(layer), "] = {\n");
  for (int o = 0; o < shape.out(layer); ++o) {
    std::string line = "   ";
    for (int i = 0; i <= shape.in(layer); ++i) {
      const std::string literal = " " + Literal(*weight++) + ",";
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

// The calls that take the values from layer to layer, forth and back between x and y, to z.
std::string Passes(const NetworkShape& shape) {
  int widest = kEncodedSize;
  for (int units : shape.hidden()) widest = std::max(widest, units);
  std::string text =
      StrCat("  double x[", widest, "], y[", widest, "], z[3];\n",
             "  if (!(i[2] > 0.0 && o[2] > 0.0)) {\n",
             "    rgb[0] = rgb[1] = rgb[2] = 0.0f;\n    return;\n  }\n", "  @_encode(i, o, x);\n");
  char from = 'x';
  for (int l = 0; l < shape.num_layers(); ++l) {
    const bool last = l + 1 == shape.num_layers();
    const char to = last ? 'z' : from == 'x' ? 'y' : 'x';
    text += StrCat("  @_layer(@_w", l + 1, ", ", shape.in(l), ", ", shape.out(l), ", ", from, ", ",
                   to, ");\n");
    if (!last) text += StrCat("  @_activate(", to, ", ", shape.out(l), ");\n");
    from = to;
  }
  return text;
}

}  // namespace

std::string CSource(const NeuralBrdf& fitted, const std::string& name) {
  const NeuralBrdf network = fitted.WithRgbOutputs();
  CheckIdentifier(name);
  const NetworkShape& shape = network.shape();
  std::string text(kHead);
  for (int l = 0; l < shape.num_layers(); ++l) text += WeightArray(network, l);
  text += EncoderText(shape.encoding(), kEncoderTexts);
  text += kLayer;
  text += shape.activation() == Activation::kTanh ? "tanh(y[i])" : "y[i] > 0.0 ? y[i] : 0.0";
  text += kEval;
  text += Passes(shape);
  text += kOutput;
  return StrCat("/* ", CommentText(network), ".\n   Written by pbnbrdf.\n", WithName(text, name));
}

}  // namespace pbnbrdf
