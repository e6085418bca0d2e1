// Any source as a file of the RGL database's format (sources/rgl.h). The density of normals comes from
// backscattering, as in the measurements [1, section 3]: light that returns was reflected by normals that face it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/pi.h"
#include "export/formats.h"
#include "export/primaries.h"
#include "pbnbrdf/brdf/luminance.h"
#include "sources/rgl_square.h"
#include "sources/tensor_writer.h"

namespace pbnbrdf {
namespace {

// The sizes of the database's files. Anisotropic ones have a node of phi_i every 22.5 degrees.
constexpr std::size_t kThetaI = 8, kAnisotropicPhiI = 17, kNormals = 128, kColors = 32;
// Rows of the density of normals, both ends of the circle among them.
constexpr std::size_t kAzimuths = 33;
// The sixth changes no density by more than 1e-4 of the largest: four built-in materials.
constexpr int kPowerSteps = 6;
// The part of all normals that face everywhere alike: colours get some resolution where little is reflected back. Of 0.02,
// 0.1 and 0.3 the nearest to these materials.
constexpr double kEverywhere = 0.1;
// The source is asked there for the node at 90 degrees.
constexpr double kLastTheta = 89.0 * kPi / 180.0;

double At(std::size_t k, std::size_t count) {
  return static_cast<double>(k) / static_cast<double>(count - 1);
}

// The density of normals D and the area sigma that they show to a direction, at kAzimuths x kNormals directions of
// the square.
class Normals {
 public:
  explicit Normals(const Brdf& source);

  double Density(const SquarePoint& at) const { return Value(density_, at); }
  double Area(const Vec3& w) const {
    return Value(area_, {ElevationColumn(Elevation(w)), AzimuthRow(Azimuth(w))});
  }
  const std::vector<float>& density() const { return density_; }
  const std::vector<float>& area() const { return area_; }

 private:
  static double Value(const std::vector<float>& table, const SquarePoint& at) {
    return Bilinear(table.data(), kAzimuths, kNormals, at.x, at.y);
  }
  void UpdateArea(bool isotropic);
  void Normalize();

  std::vector<Vec3> directions_;
  std::vector<double> solid_angles_;
  std::vector<float> density_, area_;
};

Normals::Normals(const Brdf& source) {
  std::vector<DirectionPair> back;
  for (std::size_t row = 0; row < kAzimuths; ++row) {
    for (std::size_t column = 0; column < kNormals; ++column) {
      const double x = At(column, kNormals);
      const Vec3 w = DirectionAt({x, At(row, kAzimuths)}, 0.0);
      const bool ends = row == 0 || row + 1 == kAzimuths;
      directions_.push_back(w);
      // theta = pi/2 x^2 and phi, both by the trapezoid rule.
      solid_angles_.push_back(std::sin(0.5 * kPi * x * x) * kPi * x / double(kNormals - 1) *
                              (ends ? 0.5 : 1.0) * 2.0 * kPi / double(kAzimuths - 1));
      back.push_back({w, w});
    }
  }
  std::vector<Rgb> values(back.size());
  source.Evaluate(back, values);
  density_.assign(back.size(), 1.0f);
  for (int step = 0; step < kPowerSteps; ++step) {
    UpdateArea(source.IsIsotropic());
    for (std::size_t n = 0; n < back.size(); ++n) {
      const double cos = std::max(directions_[n].z, 0.0);
      density_[n] = static_cast<float>(Luminance(values[n]) * cos * area_[n]);
    }
    Normalize();
  }
  for (float& density : density_) {
    density = static_cast<float>((1.0 - kEverywhere) * density + kEverywhere / kPi);
  }
  UpdateArea(source.IsIsotropic());
}

void Normals::UpdateArea(bool isotropic) {
  area_.resize(density_.size());
  for (std::size_t n = 0; n < area_.size(); ++n) {
    if (isotropic && n >= kNormals) {
      area_[n] = area_[n - kNormals];
      continue;
    }
    double area = 0.0;
    for (std::size_t m = 0; m < density_.size(); ++m) {
      area += density_[m] * std::max(Dot(directions_[n], directions_[m]), 0.0) * solid_angles_[m];
    }
    area_[n] = static_cast<float>(area);
  }
}

// So that the normals' area seen from above is 1; where nothing returns, they face everywhere alike.
void Normals::Normalize() {
  double area = 0.0;
  for (std::size_t n = 0; n < density_.size(); ++n) {
    area += density_[n] * std::max(directions_[n].z, 0.0) * solid_angles_[n];
  }
  for (float& density : density_) {
    density = area > 0.0 ? static_cast<float>(density / area) : static_cast<float>(1.0 / kPi);
  }
}

// What a file has of all incident directions.
struct Tables {
  std::vector<float> theta_i, phi_i, vndf, luminance, rgb;
};

Tables NodesFor(bool isotropic) {
  Tables tables;
  for (std::size_t k = 0; k < kThetaI; ++k) {
    tables.theta_i.push_back(static_cast<float>(std::acos(1.0 - At(k, kThetaI))));
  }
  if (isotropic) {
    tables.phi_i = {0.0f};
    return tables;
  }
  for (std::size_t k = 0; k < kAnisotropicPhiI; ++k) {
    tables.phi_i.push_back(static_cast<float>((2.0 * At(k, kAnisotropicPhiI) - 1.0) * kPi));
  }
  return tables;
}

// The normals that wi sees, over the square.
std::vector<float> VisibleNormals(const Normals& normals, const Vec3& wi) {
  std::vector<float> visible;
  for (std::size_t row = 0; row < kNormals; ++row) {
    for (std::size_t column = 0; column < kNormals; ++column) {
      const SquarePoint at = {At(column, kNormals), At(row, kNormals)};
      const Vec3 normal = DirectionAt(at, 0.0);
      visible.push_back(static_cast<float>(normals.Density(at) * std::max(Dot(wi, normal), 0.0) *
                                           at.x * std::hypot(normal.x, normal.y)));
    }
  }
  return visible;
}

// Adds the tables of one incident direction.
void AddSlice(const Brdf& source, const Normals& normals, const Vec3& wi, Tables* tables) {
  const std::vector<float> visible = VisibleNormals(normals, wi);
  tables->vndf.insert(tables->vndf.end(), visible.begin(), visible.end());
  const WarpTables warp(visible, kNormals, kNormals);
  TableBlend only;
  only.Add(0, 1.0);
  std::vector<DirectionPair> pairs;
  std::vector<double> factors;
  for (std::size_t row = 0; row < kColors; ++row) {
    for (std::size_t column = 0; column < kColors; ++column) {
      const SquarePoint normal = warp.FromUniform(only, {At(column, kColors), At(row, kColors)});
      pairs.push_back({wi, ReflectedAt(wi, DirectionAt(normal, 0.0))});
      factors.push_back(std::max(pairs.back().wo.z, 0.0) * 4.0 * normals.Area(wi) /
                        normals.Density(normal));
    }
  }
  std::vector<Rgb> values(pairs.size());
  source.Evaluate(pairs, values);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      tables->rgb.push_back(static_cast<float>(values[n][c] * factors[n]));
    }
  }
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    tables->luminance.push_back(static_cast<float>(Luminance(values[n]) * factors[n]));
  }
}

// [slices][wavelengths][kColors x kColors]
std::vector<float> Spectra(const std::vector<float>& rgb) {
  constexpr std::size_t kSize = kColors * kColors;
  const std::vector<Vec3> primaries = SpectraOfPrimaries();
  std::vector<float> spectra;
  for (std::size_t first = 0; first < rgb.size(); first += 3 * kSize) {
    for (const Vec3& primary : primaries) {
      for (std::size_t n = first; n < first + kSize; ++n) {
        spectra.push_back(static_cast<float>(primary.x * rgb[n] + primary.y * rgb[n + kSize] +
                                             primary.z * rgb[n + 2 * kSize]));
      }
    }
  }
  return spectra;
}

// All but the colours.
TensorWriter FileOf(const Brdf& source, const Normals& normals, const Tables& tables) {
  // Rows that are all the same are stored twice, the least that a table has.
  const std::uint64_t n_phi = tables.phi_i.size(), rows = source.IsIsotropic() ? 2 : kAzimuths;
  const auto stored = [&](const std::vector<float>& table) {
    return std::vector<float>(table.begin(), table.begin() + std::ptrdiff_t(rows * kNormals));
  };
  TensorWriter file;
  file.AddBytes("description", source.Description()).AddBytes("jacobian", "\1");
  file.AddFloats("phi_i", {n_phi}, tables.phi_i).AddFloats("theta_i", {kThetaI}, tables.theta_i);
  file.AddFloats("sigma", {rows, kNormals}, stored(normals.area()));
  file.AddFloats("ndf", {rows, kNormals}, stored(normals.density()));
  file.AddFloats("vndf", {n_phi, kThetaI, kNormals, kNormals}, tables.vndf);
  file.AddFloats("luminance", {n_phi, kThetaI, kColors, kColors}, tables.luminance);
  return file;
}

Tables TablesOf(const Brdf& source, const Normals& normals) {
  Tables tables = NodesFor(source.IsIsotropic());
  for (double phi : tables.phi_i) {
    for (double theta : tables.theta_i) {
      AddSlice(source, normals, FromSpherical(std::min(theta, kLastTheta), phi), &tables);
    }
  }
  return tables;
}

}  // namespace

std::string RglFile(const Brdf& source) {
  const Normals normals(source);
  const Tables tables = TablesOf(source, normals);
  return FileOf(source, normals, tables)
      .AddFloats("rgb", {tables.phi_i.size(), kThetaI, 3, kColors, kColors}, tables.rgb)
      .Bytes();
}

std::string SpectralRglFile(const Brdf& source) {
  const Normals normals(source);
  const Tables tables = TablesOf(source, normals);
  const std::vector<float> wavelengths = PrimaryWavelengths();
  return FileOf(source, normals, tables)
      .AddFloats("wavelengths", {wavelengths.size()}, wavelengths)
      .AddFloats("spectra", {tables.phi_i.size(), kThetaI, wavelengths.size(), kColors, kColors},
                 Spectra(tables.rgb))
      .Bytes();
}

}  // namespace pbnbrdf
