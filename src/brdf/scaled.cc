#include "pbnbrdf/brdf/scaled.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/albedo.h"

namespace pbnbrdf {
namespace {

constexpr double kLastAngle = 85.0 * std::numbers::pi / 180.0;
constexpr AlbedoGrid kGrid = {
    .angles = 64, .azimuths = 8, .refine_above = 0.0, .n_theta = 2, .n_phi = 64, .tolerance = 1e-4};

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
  double largest = 0.0;
  const auto take = [&](double theta_i, const Rgb& albedo) {
    for (double a : albedo) {
      if (!std::isfinite(a)) Fail("the directional albedo at theta_i = ", theta_i, " is ", a);
      largest = std::max(largest, a);
    }
  };
  for (const IncidentAlbedo& at : AlbedoProfile(brdf, kGrid)) {
    if (at.theta_i < kLastAngle) take(at.theta_i, at.albedo);
  }
  const auto quadrature = AlbedoQuadrature::OnMerlRows(kGrid.n_theta, kGrid.n_phi);
  const int azimuths = brdf.IsIsotropic() ? 1 : kGrid.azimuths;
  for (int p = 0; p < azimuths; ++p) {
    const Vec3 wi = FromSpherical(kLastAngle, 2.0 * std::numbers::pi * p / azimuths);
    take(kLastAngle, DirectionalAlbedo(brdf, wi, quadrature));
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
