#include "sky.h"

#include <cmath>

#include "base/pi.h"
#include "rgb.h"

namespace pbnbrdf {
namespace {

// Texels of 0.35 degrees, with 4 x 4 directions each, resolve the real sun, of 0.53 degrees.
constexpr int kWidth = 1024, kHeight = 512, kSub = 4;

Rgb Radiance(const Sky& sky, const Vec3& direction) {
  if (sky.sun_radius > 0.0 &&
      Dot(direction, sky.sun_direction) >= std::cos(sky.sun_radius * kPi / 180.0)) {
    return sky.sun;
  }
  if (direction.y < 0.0) return sky.ground;
  return sky.horizon + direction.y * (sky.zenith - sky.horizon);
}

}  // namespace

Image SkyImage(const Sky& sky) {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      Rgb sum = {};
      for (int k = 0; k < kSub * kSub; ++k) {
        const double theta = kPi * (y + (k / kSub + 0.5) / kSub) / kHeight;
        const double phi = 2.0 * kPi * (x + (k % kSub + 0.5) / kSub) / kWidth;
        sum = sum + Radiance(sky, {std::sin(theta) * std::sin(phi), std::cos(theta),
                                   -std::sin(theta) * std::cos(phi)});
      }
      for (std::size_t c = 0; c < 3; ++c) image.pixel(x, y)[c] = float(sum[c] / (kSub * kSub));
    }
  }
  return image;
}

Image ConstantImage(const Rgb& radiance) {
  Image texel(1, 1);
  for (std::size_t c = 0; c < 3; ++c) texel.rgb[c] = static_cast<float>(radiance[c]);
  return texel;
}

}  // namespace pbnbrdf
