// render_test_util.h: simple scenes, and comparisons of their images with known radiance.
#pragma once

#include <functional>

#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/render/render.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "test_util.h"

namespace pbnbrdf {

inline Vec3 operator-(const Vec3& v) { return -1.0 * v; }

// A square image seen from +z at (0, 0, distance), +x to the right and +y up.
inline Scene SceneFrom(double distance, double field_of_view, int pixels) {
  Scene scene;
  scene.camera = {{0.0, 0.0, distance}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, field_of_view};
  scene.film = {pixels, pixels};
  return scene;
}

inline void AddSphere(const Vec3& center, double radius, const std::string& source, Scene* scene) {
  Shape shape;
  shape.sphere =
      SphereShape{Compose(Affine::Translation(center), Affine::Scaling({radius, radius, radius}))};
  shape.material = static_cast<int>(scene->materials.size());
  scene->materials.push_back({source, source});
  scene->shapes.push_back(shape);
}

// x, y: half of its sides.
inline void AddRectangle(const Vec3& center, const Vec3& x, const Vec3& y,
                         const std::string& source, Scene* scene) {
  Shape shape;
  shape.mesh = {ParallelogramMesh(center, x, y), x};
  shape.material = static_cast<int>(scene->materials.size());
  scene->materials.push_back({source, source});
  scene->shapes.push_back(shape);
}

// "white:0.5" is Lambertian with that albedo; OpenBrdf opens all else.
inline std::unique_ptr<Brdf> OpenTestMaterial(const std::string& source) {
  if (!source.starts_with("white:")) return OpenBrdf(source);
  const double rho = ParseNumber("rho", source.substr(6));
  return std::make_unique<LambertBrdf>(Rgb{rho, rho, rho});
}

inline Rendering RenderTest(const Scene& scene, const RenderOptions& options) {
  return Render(
      scene, [](const std::string& source) { return OpenedMaterial{OpenTestMaterial(source)}; },
      options);
}

// The mean of a pixel over 8 x 8 directions, given the radiance that the camera of SceneFrom sees.
inline double PixelMean(const Scene& scene, int x, int y,
                        const std::function<double(const Vec3&)>& radiance) {
  constexpr int kSub = 8;
  const double half = std::tan(scene.camera.field_of_view * kPi / 360.0);
  double sum = 0.0;
  for (int k = 0; k < kSub * kSub; ++k) {
    const double u = (x + (k % kSub + 0.5) / kSub) / scene.film.width;
    const double v = (y + (k / kSub + 0.5) / kSub) / scene.film.height;
    sum += radiance(Normalized(Vec3{(2.0 * u - 1.0) * half, (1.0 - 2.0 * v) * half, -1.0}));
  }
  return sum / (kSub * kSub);
}

// The distance from a point outside of the sphere to its near side; 0 if the ray misses it.
inline double DistanceToSphere(const Vec3& from, const Vec3& direction, const Vec3& center,
                               double radius) {
  const Vec3 o = from - center;
  const double b = Dot(o, direction), c = Dot(o, o) - radius * radius;
  return b * b - c < 0.0 ? 0.0 : -b - std::sqrt(b * b - c);
}

struct MeanAndError {
  double mean, error;  // one standard error
};

inline MeanAndError MeanOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (double value : values) sum += value;
  for (double value : values) squares += (value - sum / n) * (value - sum / n);
  return {sum / n, std::sqrt(squares / (n - 1.0) / n)};
}

// Expects that one channel of the image differs from the expected means by noise only: in each quarter
// of the image the mean difference is 0 within 3 standard errors. relative_error: of the expected means
// themselves, relative to the largest of them.
inline void ExpectNoiseOnly(const Image& image, int channel,
                            const std::function<double(int, int)>& expected,
                            double relative_error) {
  std::array<std::vector<double>, 4> differences;
  double largest = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double value = expected(x, y);
      largest = std::max(largest, std::abs(value));
      differences[(2 * x >= image.width) + 2 * (2 * y >= image.height)].push_back(
          image.pixel(x, y)[channel] - value);
    }
  }
  EXPECT_GT(largest, 0.0);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const MeanAndError difference = MeanOf(differences[quarter]);
    EXPECT_LE(std::abs(difference.mean), 3.0 * difference.error + relative_error * largest)
        << "quarter " << quarter << ", standard error " << difference.error;
    EXPECT_LT(difference.error, 0.03 * largest) << "the noise hides everything";
  }
}

}  // namespace pbnbrdf
