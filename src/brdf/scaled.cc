#include "pbnbrdf/brdf/scaled.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/albedo.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kLastDegree = 85;      // of theta_i, every degree
constexpr int kAzimuthDegrees = 15;  // from one phi_i to the next

Vec3 Turned(const Vec3& v, double cosine, double sine) {
  return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z};
}

// A source as it looks where the light comes from the azimuth phi in place of 0.
class TurnedBrdf final : public Brdf {
 public:
  TurnedBrdf(const Brdf& source, double phi)
      : source_(source), cosine_(std::cos(phi)), sine_(std::sin(phi)) {}

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    std::vector<DirectionPair> turned;
    turned.reserve(pairs.size());
    for (const auto& [wi, wo] : pairs) {
      turned.push_back({Turned(wi, cosine_, sine_), Turned(wo, cosine_, sine_)});
    }
    source_.EvaluateUnclipped(turned, values);
  }
  std::string Description() const override { return source_.Description() + ", turned"; }

 private:
  const Brdf& source_;
  double cosine_, sine_;
};

// The one place that integrates.
Rgb AlbedoAt(const Brdf& brdf, double theta_i, double phi_i) {
  if (phi_i == 0.0) return DirectionalAlbedo(brdf, theta_i);
  return DirectionalAlbedo(TurnedBrdf(brdf, phi_i), theta_i);
}

}  // namespace

ScaledBrdf::ScaledBrdf(std::unique_ptr<Brdf> source, double factor)
    : source_(std::move(source)), factor_(factor) {
  if (!(factor >= 0.0) || !std::isfinite(factor)) {
    Fail("factor = ", factor, "; must be finite and >= 0");
  }
}

void ScaledBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                   std::span<Rgb> values) const {
  source_->EvaluateUnclipped(pairs, values);
  for (Rgb& value : values) {
    for (double& channel : value) channel = std::min(channel * factor_, kLargestValue);
  }
}

std::string ScaledBrdf::Description() const {
  return StrCat(source_->Description(), ", times ", factor_);
}

double LargestAlbedo(const Brdf& brdf) {
  const int azimuths = brdf.IsIsotropic() ? 1 : 360 / kAzimuthDegrees;
  double largest = 0.0;
  for (int azimuth = 0; azimuth < azimuths; ++azimuth) {
    for (int degree = 0; degree <= kLastDegree; ++degree) {
      for (double a : AlbedoAt(brdf, degree * kDegree, azimuth * kAzimuthDegrees * kDegree)) {
        if (!std::isfinite(a)) Fail("the directional albedo at ", degree, " degrees is ", a);
        largest = std::max(largest, a);
      }
    }
  }
  return largest;
}

std::unique_ptr<ScaledBrdf> ScaleToAlbedo(std::unique_ptr<Brdf> source, double albedo) {
  if (!(albedo > 0.0) || !std::isfinite(albedo)) {
    Fail("albedo = ", albedo, "; must be finite and > 0");
  }
  const double largest = LargestAlbedo(*source), factor = albedo / largest;
  if (!std::isfinite(factor)) {
    Fail("can't be scaled to an albedo of ", albedo, ": its largest directional albedo is ",
         largest);
  }
  return std::make_unique<ScaledBrdf>(std::move(source), factor);
}

}  // namespace pbnbrdf
