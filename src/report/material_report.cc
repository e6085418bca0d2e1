#include "report/material_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "image/srgb.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/metrics/flip.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "report/base64.h"
#include "report/curves.h"

namespace pbnbrdf {
namespace {

constexpr char kGlslName[] = "fitted";  // of the network's function in the shader

// Five digits: what a plot shows, in few bytes.
Json Rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  char text[32];
  std::snprintf(text, sizeof(text), "%.5g", value);
  return std::strtod(text, nullptr);
}

Json Rounded(const std::vector<double>& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(Rounded(value));
  return json;
}

// A list for each channel.
Json Rounded(const std::vector<Rgb>& values) {
  Json channels = Json::array();
  for (std::size_t c = 0; c < 3; ++c) {
    Json json = Json::array();
    for (const Rgb& value : values) json.push_back(Rounded(value[c]));
    channels.push_back(std::move(json));
  }
  return channels;
}

Json CurvesJson(const std::vector<PlotCurve>& curves) {
  Json json = Json::array();
  for (const PlotCurve& curve : curves) {
    json.push_back({{"angle", Rounded(curve.angle)},
                    {"x", Rounded(curve.x)},
                    {"material", Rounded(curve.material)},
                    {"fit", Rounded(curve.fit)},
                    {"measured_x", Rounded(curve.measured_x)},
                    {"measured", Rounded(curve.measured)}});
  }
  return json;
}

Json AlbedoJson(const AlbedoCurves& curves) {
  return {{"theta_i", Rounded(curves.theta_i)},
          {"material", Rounded(curves.material)},
          {"fit", Rounded(curves.fit)}};
}

std::string DataUrl(const std::string& png) { return "data:image/png;base64," + Base64(png); }

// What a screen shows of an image, linear.
Image Shown(const Image& image, double exposure) {
  Image shown = image;
  for (float& value : shown.rgb) {
    value = static_cast<float>(std::clamp(exposure * value, 0.0, 1.0));
  }
  return shown;
}

// Colours of errors from 0 to 1, dark to bright, of sRGB.
Rgb ErrorColour(double error) {
  constexpr Rgb kStops[] = {{0.00, 0.00, 0.02}, {0.25, 0.06, 0.42}, {0.65, 0.16, 0.44},
                            {0.95, 0.40, 0.30}, {1.00, 0.72, 0.35}, {1.00, 0.99, 0.75}};
  constexpr std::size_t kCells = std::size(kStops) - 1;
  const double place = kCells * std::clamp(error, 0.0, 1.0);
  const std::size_t cell = std::min(static_cast<std::size_t>(place), kCells - 1);
  const double part = place - static_cast<double>(cell);
  Rgb colour;
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = (1.0 - part) * kStops[cell][c] + part * kStops[cell + 1][c];
  }
  return colour;
}

Image ErrorPicture(const std::vector<double>& errors, int width, int height) {
  Image picture(width, height);
  for (std::size_t n = 0; n < errors.size(); ++n) {
    const Rgb colour = ErrorColour(errors[n]);
    for (std::size_t c = 0; c < 3; ++c) {
      picture.rgb[3 * n + c] = static_cast<float>(FromSrgb(colour[c]));
    }
  }
  return picture;
}

Json PicturesJson(const Image& material, const Image& fit) {
  const ImageErrors errors = CompareImages(material, fit);
  const std::vector<double> flip =
      FlipMap(Shown(material, errors.exposure), Shown(fit, errors.exposure));
  Json scale = Json::array();
  for (int n = 0; n <= 10; ++n) {
    const Rgb colour = ErrorColour(0.1 * n);
    scale.push_back({std::lround(255.0 * colour[0]), std::lround(255.0 * colour[1]),
                     std::lround(255.0 * colour[2])});
  }
  return {{"width", material.width},
          {"height", material.height},
          {"exposure", Rounded(errors.exposure)},
          {"psnr", Rounded(errors.psnr)},
          {"ssim", Rounded(errors.ssim)},
          {"flip", Rounded(errors.flip)},
          {"material", DataUrl(PngBytes(material, errors.exposure))},
          {"fit", DataUrl(PngBytes(fit, errors.exposure))},
          {"flip_map", DataUrl(PngBytes(ErrorPicture(flip, material.width, material.height)))},
          {"flip_scale", scale}};
}

// The network as GLSL, and the material as a table; null for what there is not: an analytic model has no
// network, and an anisotropic material no small table.
Json SphereJson(const ReportSubject& subject) {
  Json sphere = {{"glsl", nullptr}, {"table", nullptr}};
  if (const auto* network = dynamic_cast<const NeuralBrdf*>(&subject.fit)) {
    sphere["glsl"] = ExportedFiles(*network, "glsl", "fitted.glsl", kGlslName).at(0).content;
  }
  if (subject.material.IsIsotropic()) {
    const ValueTableSize& size = subject.table;
    const std::vector<std::uint16_t> table = ValueTable(subject.material, size);
    std::string bytes;  // little endian
    for (const std::uint16_t value : table) {
      bytes += static_cast<char>(value & 0xff);
      bytes += static_cast<char>(value >> 8);
    }
    sphere["table"] = {{"size", {size.theta_h, size.theta_d, size.phi_d}},
                       {"unit", kValueTableUnit},
                       {"half_floats", Base64(bytes)}};
  }
  return sphere;
}

}  // namespace

Json MaterialReport(const ReportSubject& subject) {
  return {{"name", subject.name},
          {"source", subject.source},
          {"fit_file", subject.fit_file},
          {"description", subject.fit.Description()},
          {"command", subject.command},
          {"measures", subject.measures},
          {"cautions", subject.cautions},
          {"history", subject.history},
          {"pictures", PicturesJson(subject.material_picture, subject.fit_picture)},
          {"curves",
           {{"in_plane", CurvesJson(InPlaneCurves(subject.material, subject.fit))},
            {"half_angle", CurvesJson(HalfAngleCurves(subject.material, subject.fit))},
            {"albedo", AlbedoJson(MeasureAlbedoCurves(subject.material, subject.fit))}}},
          {"sphere", SphereJson(subject)}};
}

}  // namespace pbnbrdf
