#include "pbnbrdf/sources/rgl.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/pi.h"
#include "pbnbrdf/base/error.h"
#include "sources/cie.h"
#include "sources/rgl_square.h"
#include "sources/tensor_file.h"
#include "sources/warp_tables.h"

namespace pbnbrdf {
namespace {

constexpr double kLeastJacobian = 1e-6;
constexpr double kDegree = kPi / 180.0;
constexpr double kLastKnown = 85.0 * kDegree, kLastEstimated = 89.4 * kDegree;
constexpr double kLastMeasured = 89.9 * kDegree;
// Of the best estimate: what is added to values before the logarithm, the cubic's share of it, and how fast
// certainty falls between nodes. A larger share or a faster fall brings fits nearer at measured angles, and
// farther in pictures (experiments/measured.cc).
constexpr double kLogOffset = 0.03, kCubicShare = 0.6, kDoubt = 7.7;
constexpr std::size_t kShownText = 60;     // of a file's own description
constexpr std::size_t kMostIsotropic = 2;  // phi_i nodes
constexpr float kLastElevation = 1.5708f;  // pi / 2, rounded up
constexpr float kLastAzimuth = 6.28319f;   // 2 pi, rounded up
// Negative values down to this part of the largest are rounding: published files have some of -4e-10.
constexpr float kNoise = 1e-6f;

using Shape = std::vector<std::size_t>;

struct Table {
  std::size_t rows = 0, columns = 0;
  std::vector<float> values;

  double At(double x, double y) const { return Bilinear(values.data(), rows, columns, x, y); }
};

// The place of an angle among ascending nodes, of which there may be only one.
NodePosition PlaceAmong(const std::vector<float>& nodes, double angle) {
  if (nodes.size() == 1) return {0, 0.0};
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), angle);
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(nodes.size()) - 2;
  const auto below = std::clamp<std::ptrdiff_t>(above - nodes.begin() - 1, 0, last);
  const double width = double(nodes[below + 1]) - nodes[below];
  return {static_cast<std::size_t>(below), std::clamp((angle - nodes[below]) / width, 0.0, 1.0)};
}

std::vector<float> ReadNodes(const TensorFile& file, const std::string& name, float least,
                             float most) {
  const std::vector<float> nodes = file.Floats(name, file.FloatShape(name, 1));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!(nodes[k] >= least && nodes[k] <= most) || (k > 0 && !(nodes[k] > nodes[k - 1]))) {
      Fail(file.path(), ": element ", k, " of field '", name, "' is ", nodes[k],
           "; must ascend from ", least, " to ", most);
    }
  }
  return nodes;
}

// The slope at a node between intervals of these widths and secants, by which a cubic between nodes stays
// monotone: a weighted harmonic mean (rgl.h, [2]).
double MonotoneSlope(double width0, double secant0, double width1, double secant1) {
  if (secant0 * secant1 <= 0.0) return 0.0;
  const double w0 = 2.0 * width1 + width0, w1 = width1 + 2.0 * width0;
  return (w0 + w1) / (w0 / secant0 + w1 / secant1);
}

// Two last sizes of a field's shape; at least 2 x 2.
Table ReadShape(const TensorFile& file, const std::string& name, const Shape& shape) {
  Table table{shape[shape.size() - 2], shape[shape.size() - 1], {}};
  if (table.rows < 2 || table.columns < 2) {
    Fail(file.path(), ": field '", name, "' is ", ShapeText(shape),
         "; its tables must be at least 2 x 2");
  }
  return table;
}

std::vector<float> ReadNonNegative(const TensorFile& file, const std::string& name,
                                   const Shape& shape) {
  std::vector<float> values = file.Floats(name, shape);
  const float least = -kNoise * *std::max_element(values.begin(), values.end());
  const auto bad = std::find_if(values.begin(), values.end(),
                                [&](float v) { return v < 0.0f && !(v >= least); });
  if (bad != values.end()) {
    Fail(file.path(), ": element ", bad - values.begin(), " of field '", name, "' is ", *bad,
         "; must be >= 0");
  }
  for (float& value : values) value = std::max(value, 0.0f);
  return values;
}

Table ReadTable(const TensorFile& file, const std::string& name) {
  const Shape shape = file.FloatShape(name, 2);
  Table table = ReadShape(file, name, shape);
  table.values = ReadNonNegative(file, name, shape);
  return table;
}

WarpTables ReadWarp(const TensorFile& file, const std::string& name, std::size_t n_phi,
                    std::size_t n_theta, Table* size) {
  Shape shape = file.FloatShape(name, 4);
  *size = ReadShape(file, name, shape);
  shape[0] = n_phi, shape[1] = n_theta;  // what they must be
  return WarpTables(ReadNonNegative(file, name, shape), size->rows, size->columns);
}

}  // namespace

struct RglBrdf::Tables {
  // Where a pair lies in all the tables.
  struct Place {
    NodePosition phi, theta;  // of wi, among the nodes
    TableBlend blend;         // of the tables at these
    SquarePoint normal;       // of the half vector
    SquarePoint color;        // in the tables of colours
    double scale;             // D / (4 sigma)
  };

  explicit Tables(const TensorFile& file);

  bool is_spectral() const { return !wavelengths.empty(); }
  NodePosition ThetaAt(const Vec3& wi) const { return PlaceAmong(theta_i, Elevation(wi)); }
  NodePosition PhiAt(const Vec3& wi) const;
  TableBlend Blend(const NodePosition& phi, const NodePosition& theta) const;
  SquarePoint NormalAt(const Vec3& wi, const Vec3& half) const;
  Place Locate(const DirectionPair& pair) const;
  Rgb Value(const DirectionPair& pair, Interpolation interpolation) const;
  double Linear(const Place& place, std::size_t channel) const;
  double MonotoneCubic(const Place& place, std::size_t channel) const;
  double AtNode(const Place& place, std::size_t theta, std::size_t channel) const;
  std::size_t measured_angles() const;  // the first so many of theta_i
  double Doubt(double theta) const;
  void ReadColors(const TensorFile& file);
  double Pdf(const Vec3& wi, const Vec3& wo) const;
  Tables Without(std::size_t theta) const;

  std::vector<float> theta_i, phi_i;  // radians, ascending
  bool isotropic;
  Table ndf, sigma;
  Table color_size;
  WarpTables vndf, luminance;
  std::vector<float> wavelengths;
  // [phi_i][theta_i][channel][row][column]: RGB, and of a spectral file all that was measured.
  std::vector<float> colors, spectra;
  std::string text;
};

RglBrdf::Tables::Tables(const TensorFile& file)
    : theta_i(ReadNodes(file, "theta_i", 0.0f, kLastElevation)),
      phi_i(ReadNodes(file, "phi_i", -kLastAzimuth, kLastAzimuth)),
      isotropic(phi_i.size() <= kMostIsotropic),
      ndf(ReadTable(file, "ndf")),
      sigma(ReadTable(file, "sigma")),
      vndf(ReadWarp(file, "vndf", phi_i.size(), theta_i.size(), &color_size)),
      luminance(ReadWarp(file, "luminance", phi_i.size(), theta_i.size(), &color_size)),
      text(file.Text("description")) {
  const double span = double(phi_i.back()) - phi_i.front();
  if (!isotropic && std::round(2.0 * kPi / span) != 1.0) {
    Fail(file.path(), ": its phi_i span ", span, " radians; files cut down to less than the whole ",
         "circle by a symmetry aren't read");
  }
  if (!file.Has("jacobian")) Fail(file.path(), ": no field 'jacobian' in it");
  ReadColors(file);
}

void RglBrdf::Tables::ReadColors(const TensorFile& file) {
  const std::size_t size = color_size.rows * color_size.columns;
  if (!file.Has("spectra")) {
    colors = file.Floats(
        "rgb", Shape{phi_i.size(), theta_i.size(), 3, color_size.rows, color_size.columns});
    return;
  }
  wavelengths = ReadNodes(file, "wavelengths", 1.0f, kLongestWavelength);
  const std::size_t n = wavelengths.size();
  spectra = file.Floats(
      "spectra", Shape{phi_i.size(), theta_i.size(), n, color_size.rows, color_size.columns});
  std::vector<Rgb> weights;
  try {
    weights = SpectrumToRgb(wavelengths);
  } catch (const Error& error) {
    Fail(file.path(), ": ", error.what());
  }
  // Linear, as the interpolation of the tables is: what is blended later may be weighed now.
  std::vector<double> sums(3 * size);
  for (std::size_t slice = 0; slice < phi_i.size() * theta_i.size(); ++slice) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t k = 0; k < n; ++k) {
      const float* spectrum = &spectra[(slice * n + k) * size];
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < size; ++i) sums[c * size + i] += weights[k][c] * spectrum[i];
      }
    }
    for (double sum : sums) colors.push_back(static_cast<float>(sum));
  }
}

NodePosition RglBrdf::Tables::PhiAt(const Vec3& wi) const {
  const double azimuth = Azimuth(wi);
  const bool turn = !isotropic && azimuth < phi_i.front();  // nodes from 0 to 2 pi
  return PlaceAmong(phi_i, turn ? azimuth + 2.0 * kPi : azimuth);
}

TableBlend RglBrdf::Tables::Blend(const NodePosition& phi, const NodePosition& theta) const {
  TableBlend blend;
  for (std::size_t p = 0; p < 2; ++p) {
    for (std::size_t t = 0; t < 2; ++t) {
      const double weight = (p == 1 ? phi.fraction : 1.0 - phi.fraction) *
                            (t == 1 ? theta.fraction : 1.0 - theta.fraction);
      blend.Add((phi.below + p) * theta_i.size() + theta.below + t, weight);
    }
  }
  return blend;
}

SquarePoint RglBrdf::Tables::NormalAt(const Vec3& wi, const Vec3& half) const {
  return {ElevationColumn(Elevation(half)),
          AzimuthRow(isotropic ? Azimuth(half) - Azimuth(wi) : Azimuth(half))};
}

RglBrdf::Tables::Place RglBrdf::Tables::Locate(const DirectionPair& pair) const {
  const Vec3 sum = pair.wi + pair.wo;
  Place place;
  place.phi = PhiAt(pair.wi);
  place.theta = ThetaAt(pair.wi);
  place.blend = Blend(place.phi, place.theta);
  place.normal = NormalAt(pair.wi, (1.0 / Length(sum)) * sum);
  place.color = vndf.ToUniform(place.blend, place.normal);
  const double area = sigma.At(ElevationColumn(Elevation(pair.wi)), AzimuthRow(Azimuth(pair.wi)));
  const double density = ndf.At(place.normal.x, place.normal.y);
  place.scale = area > 0.0 ? density / (4.0 * area) : 0.0;
  return place;
}

double RglBrdf::Tables::Linear(const Place& place, std::size_t channel) const {
  const std::size_t size = color_size.rows * color_size.columns;
  double blended = 0.0;
  for (int k = 0; k < place.blend.count; ++k) {
    blended += place.blend.weights[k] *
               Bilinear(&colors[(3 * place.blend.tables[k] + channel) * size], color_size.rows,
                        color_size.columns, place.color.x, place.color.y);
  }
  return blended;
}

// Blended over phi_i alone.
double RglBrdf::Tables::AtNode(const Place& place, std::size_t theta, std::size_t channel) const {
  Place there = place;
  there.blend = Blend(place.phi, {theta, 0.0});
  return Linear(there, channel);
}

std::size_t RglBrdf::Tables::measured_angles() const {
  return theta_i.size() - (theta_i.size() > 1 && theta_i.back() > kLastMeasured);
}

double RglBrdf::Tables::MonotoneCubic(const Place& place, std::size_t channel) const {
  const auto [below, t] = place.theta;
  if (t == 0.0) return Linear(place, channel);
  const auto at = [&](std::size_t k) {
    return std::log(std::max(AtNode(place, k, channel), 0.0) + kLogOffset);
  };
  const auto width = [&](std::size_t k) { return double(theta_i[k + 1]) - theta_i[k]; };
  const double h = width(below), y0 = at(below), y1 = at(below + 1), secant = (y1 - y0) / h;
  double slope0 = secant, slope1 = secant;
  if (below > 0) {
    const double h0 = width(below - 1);
    slope0 = MonotoneSlope(h0, (y0 - at(below - 1)) / h0, h, secant);
  }
  if (below + 2 < measured_angles()) {
    const double h1 = width(below + 1);
    slope1 = MonotoneSlope(h, secant, h1, (at(below + 2) - y1) / h1);
  }
  const double s = 1.0 - t;
  const double y = s * s * (1.0 + 2.0 * t) * y0 + t * t * (3.0 - 2.0 * t) * y1 +
                   h * t * s * (s * slope0 - t * slope1);
  return std::exp(y) - kLogOffset;
}

Rgb RglBrdf::Tables::Value(const DirectionPair& pair, Interpolation interpolation) const {
  const Place place = Locate(pair);
  const double scale = place.scale / pair.wo.z;
  Rgb value;
  for (std::size_t c = 0; c < 3; ++c) {
    double v = Linear(place, c);
    if (interpolation == Interpolation::kBest) v += kCubicShare * (MonotoneCubic(place, c) - v);
    value[c] = v > 0.0 ? std::min(v * scale, kLargestValue) : 0.0;
  }
  return value;
}

// How far from the measured angles, as a fraction of the interval that theta is in.
double RglBrdf::Tables::Doubt(double theta) const {
  const NodePosition at = PlaceAmong(theta_i, theta);
  const bool has_next = at.below + 1 < measured_angles();
  return has_next ? std::min(at.fraction, 1.0 - at.fraction) : at.fraction;
}

double RglBrdf::Tables::Pdf(const Vec3& wi, const Vec3& wo) const {
  const Vec3 sum = wi + wo;
  const double length = Length(sum), sin_theta = std::hypot(sum.x, sum.y) / length;
  const Place place = Locate({wi, wo});
  const double jacobian =
      4.0 * (0.5 * length) * std::max(2.0 * kPi * kPi * place.normal.x * sin_theta, kLeastJacobian);
  return vndf.Density(place.blend, place.normal) * luminance.Density(place.blend, place.color) /
         jacobian;
}

// As if the theta-th incident angle had not been measured.
RglBrdf::Tables RglBrdf::Tables::Without(std::size_t theta) const {
  const std::size_t period = theta_i.size(), count = phi_i.size() * period;
  Tables rest = *this;
  rest.theta_i = WithoutTables(theta_i, period, theta, period);
  rest.colors = WithoutTables(colors, count, theta, period);
  if (!spectra.empty()) rest.spectra = WithoutTables(spectra, count, theta, period);
  rest.vndf = vndf.Without(theta, period);
  rest.luminance = luminance.Without(theta, period);
  return rest;
}

RglBrdf::RglBrdf(std::shared_ptr<const Tables> tables, Interpolation interpolation)
    : tables_(std::move(tables)), interpolation_(interpolation) {}

RglBrdf RglBrdf::Read(const std::string& path) {
  return RglBrdf(std::make_shared<const Tables>(TensorFile::Read(path)), Interpolation::kLinear);
}

void RglBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs, std::span<Rgb> values) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    values[n] = pairs[n].AboveHorizon() ? tables_->Value(pairs[n], interpolation_) : Rgb{};
  }
}

bool RglBrdf::IsKnown(const DirectionPair& pair) const {
  const bool is_estimate = interpolation_ != Interpolation::kLinear;
  const double last =
      std::min<double>(tables_->theta_i.back(), is_estimate ? kLastEstimated : kLastKnown);
  return pair.AboveHorizon() && std::min(pair.wi.z, pair.wo.z) >= std::cos(last);
}

std::unique_ptr<Brdf> RglBrdf::BestEstimate(Estimate estimate) const {
  const auto interpolation =
      estimate == Estimate::kLikeliest ? Interpolation::kBest : Interpolation::kStored;
  return std::unique_ptr<Brdf>(new RglBrdf(tables_, interpolation));
}

double RglBrdf::Certainty(const DirectionPair& pair) const {
  if (interpolation_ == Interpolation::kStored) return 1.0;
  const double doubt = kDoubt * tables_->Doubt(Elevation(pair.wi));
  return 1.0 / (1.0 + doubt * doubt);
}

std::optional<DirectionPair> RglBrdf::NearestMeasured(const DirectionPair& pair) const {
  if (interpolation_ == Interpolation::kStored) return {};
  const NodePosition at = tables_->ThetaAt(pair.wi);
  const std::size_t nearest =
      std::min(at.below + (at.fraction > 0.5), tables_->measured_angles() - 1);
  return DirectionPair{FromSpherical(tables_->theta_i[nearest], Azimuth(pair.wi)), pair.wo};
}

std::vector<double> RglBrdf::IncidentAngles() const {
  const auto begin = tables_->theta_i.begin();
  return {begin, begin + static_cast<std::ptrdiff_t>(tables_->measured_angles())};
}

std::unique_ptr<Brdf> RglBrdf::WithoutIncidentAngle(std::size_t index) const {
  auto rest = std::make_shared<const Tables>(tables_->Without(index));
  return std::unique_ptr<Brdf>(new RglBrdf(std::move(rest), interpolation_));
}

bool RglBrdf::IsIsotropic() const { return tables_->isotropic; }

const std::vector<float>& RglBrdf::wavelengths() const { return tables_->wavelengths; }

std::string RglBrdf::Description() const {
  const Tables& t = *tables_;
  const std::string colors =
      t.is_spectral() ? StrCat(t.wavelengths.size(), " wavelengths from ", t.wavelengths.front(),
                               " to ", t.wavelengths.back(), " nm")
                      : "RGB";
  std::string text = t.text.substr(0, kShownText);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
  if (text.size() < t.text.size()) text += "...";
  return StrCat("RGL measurement, ", t.isotropic ? "isotropic" : "anisotropic", ", ", colors, ", ",
                t.phi_i.size(), " x ", t.theta_i.size(), " incident directions",
                text.empty() ? "" : ": ", text);
}

std::vector<double> RglBrdf::Spectrum(const DirectionPair& pair) const {
  const Tables& t = *tables_;
  const std::size_t n = t.wavelengths.size(), size = t.color_size.rows * t.color_size.columns;
  std::vector<double> spectrum(n, 0.0);
  if (!pair.AboveHorizon()) return spectrum;
  const Tables::Place place = t.Locate(pair);
  for (std::size_t w = 0; w < n; ++w) {
    for (int k = 0; k < place.blend.count; ++k) {
      spectrum[w] += place.blend.weights[k] *
                     Bilinear(&t.spectra[(n * place.blend.tables[k] + w) * size], t.color_size.rows,
                              t.color_size.columns, place.color.x, place.color.y);
    }
    spectrum[w] *= place.scale / pair.wo.z;
  }
  return spectrum;
}

double RglBrdf::Pdf(const Vec3& wi, const Vec3& wo) const {
  return wi.z > 0.0 && wo.z > 0.0 ? tables_->Pdf(wi, wo) : 0.0;
}

Vec3 RglBrdf::Sample(const Vec3& wi, double u0, double u1) const {
  const Tables& t = *tables_;
  const TableBlend blend = t.Blend(t.PhiAt(wi), t.ThetaAt(wi));
  const SquarePoint color = t.luminance.FromUniform(blend, {u0, u1});
  const SquarePoint normal = t.vndf.FromUniform(blend, color);
  return ReflectedAt(wi, DirectionAt(normal, t.isotropic ? Azimuth(wi) : 0.0));
}

}  // namespace pbnbrdf
