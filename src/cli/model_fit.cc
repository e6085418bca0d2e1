#include "model_fit.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "measure/measures.h"
#include "pbnbrdf/problem/sampling.h"
#ifdef PBNBRDF_HAS_RENDER
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/render/scene.h"
#include "render/studio.h"
#include "sphere_text.h"
#endif

namespace pbnbrdf::cli {
namespace {

constexpr std::string_view kPrincipled = "principled";

#ifdef PBNBRDF_HAS_RENDER
constexpr int kSphereWidth = 128, kSphereSamples = 64;

// A Brdf that someone else owns.
class BorrowedBrdf final : public Brdf {
 public:
  explicit BorrowedBrdf(const Brdf& brdf) : brdf_(brdf) {}

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    brdf_.Evaluate(pairs, values);
  }
  bool IsIsotropic() const override { return brdf_.IsIsotropic(); }
  std::string Description() const override { return brdf_.Description(); }

 private:
  const Brdf& brdf_;
};

// FLIP between pictures of a sphere of each under the sky of problems/scenes/sphere.json.
double SphereFlip(const Brdf& material, const Brdf& fit, int threads) {
  Scene scene = ParseScene(kSphereSceneText, "", {});
  scene.film = WithWidth(scene.film, kSphereWidth);
  const Studio studio(scene, material, kSphereSamples, threads);
  const auto picture = [&](const Brdf& brdf) {
    return studio.Photograph([&] { return std::make_unique<BorrowedBrdf>(brdf); });
  };
  return CompareImages(picture(material), picture(fit)).flip;
}
#endif

}  // namespace

ModelFit FitModel(const Brdf& material, const AnalyticModel& model, const SamplingOptions& sampling,
                  const AnalyticFitOptions& options) {
  const std::vector<BrdfSample> samples =
      DrawSamples(material, SampleSet::kTraining, sampling.angles, sampling.samples, sampling.seed);
  const AnalyticFit fit = FitAnalytic(samples, material.IsIsotropic(), model, options);
  Json errors = MeasureFit(material, fit.brdf, fit.brdf.parameters().size());
#ifdef PBNBRDF_HAS_RENDER
  if (model.name == kPrincipled) {
    errors["sphere_flip"] = SphereFlip(material, fit.brdf, options.threads);
  }
#endif
  return {fit, samples.size(), errors};
}

std::string ErrorsText(const Json& errors) {
  std::ostringstream text;
  text << MeasuresText(errors);
  if (errors.contains("sphere_flip")) {
    text << std::left << std::setw(33) << "sphere_flip" << std::setw(13) << std::setprecision(5)
         << errors.at("sphere_flip").get<double>()
         << "mean FLIP between pictures of a sphere under a sky, 0 to 1\n";
  }
  return text.str();
}

AnalyticBrdf PrincipledFit(const Brdf& material, const std::string& name, Json* errors) {
  SamplingOptions sampling;
  sampling.samples = kModelSamples;
  ModelFit fit = FitModel(material, FindAnalyticModel(kPrincipled), sampling, {});
  fit.fit.brdf.set_metadata({{"material", name}, {"errors", JsonLine(fit.errors)}});
  *errors = std::move(fit.errors);
  return fit.fit.brdf;
}

}  // namespace pbnbrdf::cli
