#include "pbnbrdf/brdf/scaled.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/albedo.h"

namespace pbnbrdf {
namespace {

// The same nodes whatever the values, so that the albedos of a scaled source are those of the source,
// scaled.
constexpr AlbedoGrid kGrid = {.angles = 64,
                              .last_angle = 85.0 * std::numbers::pi / 180.0,
                              .azimuths = 8,
                              .refine_above = 0.0,
                              .tolerance = 0.0,
                              .excess_tolerance = 0.0,
                              .n_theta = 3,
                              .n_phi = 64,
                              .refinements = 1};

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
  for (Rgb& value : values) Scale(&value);
}

std::vector<BrdfSample> ScaledBrdf::Measurements() const {
  std::vector<BrdfSample> samples = source_->Measurements();
  for (BrdfSample& sample : samples) Scale(&sample.value);
  return samples;
}

std::unique_ptr<Brdf> ScaledBrdf::BestEstimate(Estimate estimate) const {
  std::unique_ptr<Brdf> best = source_->BestEstimate(estimate);
  return best ? std::make_unique<ScaledBrdf>(std::move(best), factor_) : nullptr;
}

void ScaledBrdf::Scale(Rgb* value) const {
  for (double& channel : *value) channel = std::min(channel * factor_, kLargestValue);
}

std::string ScaledBrdf::Description() const {
  return StrCat(source_->Description(), ", times ", factor_);
}

double LargestAlbedo(const Brdf& brdf) {
  double largest = 0.0;
  for (const IncidentAlbedo& at : AlbedoProfile(brdf, kGrid)) {
    for (double a : at.albedo) {
      if (!std::isfinite(a)) Fail("the directional albedo at theta_i = ", at.theta_i, " is ", a);
      largest = std::max(largest, a);
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
