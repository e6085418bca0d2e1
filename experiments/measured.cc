// measured.cc: fits of real measurements: at what was measured, at angles that were left out, and as
// pictures.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "base/median.h"
#include "cpu_timer.h"
#include "curves.h"
#include "experiment.h"
#include "materials.h"
#include "measured_samples.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/reciprocal.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/models/fit_analytic.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "problems.h"
#include "render/studio.h"
#include "results.h"
#include "small_scene.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(measured: fits of real measurements, at what was measured, at incident angles that were left out
of the fit, and as pictures, beside published networks, the published recipe, and an analytic model.

  measured --out_dir=results --networks=nbrdf --adam --analytic rgl/chm_mint_rgb.bsdf ...
  measured --out_dir=results cornell/cayman.brdf zemax/aeroglaze_z307.bsdf

The arguments are materials: RGL files, or lists of measurements (Cornell, Zemax, FRED, ASTM, in-plane,
CSV). --networks is a folder of networks, NAME.h5 for NAME.bsdf. Of a list of measurements, errors are
at those that no fit has seen, and there are no pictures: between measurements nothing is known.
)" + std::string(kMaterialsHelp);

constexpr char kMeasured[] = "Error at measured directions", kAll[] = "Error at all directions",
               kAlbedo[] = "Largest directional albedo", kDeltaE[] = "Mean Delta E 2000",
               kSeconds[] = "CPU seconds", kToTarget[] = "PSNR to what our fit aims at, dB";
constexpr char kItself[] = "itself", kFloor[] = "floor", kSymmetric[] = "symmetric",
               kPublished[] = "published", kAdam[] = "our Adam", kAnalytic[] = "analytic",
               kOurs[] = "ours";
constexpr const char* kReferences[] = {" to the material", " to its reciprocal version"};

std::vector<Quantity> Quantities() {
  std::vector<Quantity> all = {{kMeasured, 3, Comparison::kRatio},
                               {kAll, 3, Comparison::kRatio},
                               {kAlbedo, 5, Comparison::kNone},
                               {kDeltaE, 2, Comparison::kRatio},
                               {kSeconds, 2, Comparison::kNone}};
  for (const char* reference : kReferences) {
    all.push_back({StrCat("PSNR", reference, ", dB"), 3, Comparison::kDifference});
    all.push_back({StrCat("SSIM", reference), 5, Comparison::kNone});
    all.push_back({StrCat("FLIP", reference), 3, Comparison::kRatio});
  }
  all.push_back({kToTarget, 3, Comparison::kNone});
  return all;
}

struct Options {
  std::string networks, scene = "problems/scenes/sphere.json", environment, sgd;
  bool adam = false, analytic = false, left_out = true, pictures = true;
  std::optional<int> epochs;
  double max_seconds = ScheduleOptions{}.max_seconds;
  int film_width = 256, samples_per_pixel = 64, threads = 0;
  std::uint64_t samples = 4000, seed = 1;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Text("networks", &o->networks, "folder of published networks, NAME.h5"));
  fields.Add(Switch("adam", &o->adam,
                    "fit by the published recipe, too: problems/nbrdf_adam.flags to the material "
                    "as its source interpolates it"));
  fields.Add(Switch("analytic", &o->analytic,
                    "fit an analytic model, too: two lobes of GGX and a diffuse part"));
  fields.Add(Switch("left_out", &o->left_out, "fit without each interior incident angle in turn"));
  fields.Add(Switch("pictures", &o->pictures, "render pictures"));
  fields.Add(OverridingInteger("epochs", &o->epochs, AtLeast(0), "epochs of the published recipe"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each of our fits"));
  fields.Add(Text("scene", &o->scene, "scene file, of one material"));
  fields.Add(Text("environment", &o->environment,
                  "OpenEXR file that takes the place of the scene's environment light"));
  fields.Add(Integer("film_width", &o->film_width, AtLeast(kSsimWindow), "pixels of each picture"));
  fields.Add(Integer("samples_per_pixel", &o->samples_per_pixel, AtLeast(1), "of each picture"));
  fields.Add(Integer("samples", &o->samples, AtLeast(1),
                     "directions at each incident angle of an RGL file, to measure errors at"));
  fields.Add(Integer("seed", &o->seed, AtLeast(0), "of the fits"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "0: one for each core"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

constexpr std::uint64_t kMeasureSeed = 1;
constexpr std::size_t kHeldOut = 50000;
constexpr std::size_t kModelSamples = 6000;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLastMaterialAngle = 85.0 * kDegree;  // nothing is known beyond

double ErrorAt(const std::vector<BrdfSample>& samples, const Brdf& fit) {
  return MeasureErrors(samples, fit).mean_abs_log_error;
}

// A Brdf that stands for the material; as often as it is wanted.
struct Candidate {
  std::string method;
  std::function<std::unique_ptr<Brdf>()> make;
  double seconds = kNone;
};

class Methods {
 public:
  explicit Methods(const Options& options) : options_(options) {}

  // All that were asked for; ours comes last.
  std::vector<Candidate> Of(const MaterialSource& source, const Brdf& material) const {
    std::vector<Candidate> all;
    const std::string published = options_.networks + "/" + source.name + ".h5";
    if (!options_.networks.empty() && IsMeasurement(source) && std::filesystem::exists(published)) {
      all.push_back({kPublished, [=] { return OpenBrdf(published); }});
    }
    if (options_.adam) all.push_back(Timed(kAdam, [&] { return Recipe(material); }));
    if (options_.analytic) all.push_back(Timed(kAnalytic, [&] { return Model(material); }));
    all.push_back(Timed(kOurs, [&] { return Ours(material); }));
    return all;
  }

  NeuralBrdf Ours(const Brdf& material) const {
    FitSetup setup;
    setup.options.schedule.max_seconds = options_.max_seconds;
    return FitBy(std::move(setup), material);
  }

 private:
  template <typename Function>
  static Candidate Timed(const char* method, Function fit) {
    const CpuTimer timer;
    auto brdf = fit();
    const double seconds = timer.Seconds();
    return {method, [brdf] { return std::make_unique<decltype(brdf)>(brdf); }, seconds};
  }

  NeuralBrdf FitBy(FitSetup setup, const Brdf& material) const {
    setup.problem.sampling.seed = options_.seed;
    setup.options.threads = options_.threads;
    return FitBrdf(material, setup.problem, setup.options).network;
  }

  NeuralBrdf Recipe(const Brdf& material) const {
    FitSetup setup = ShippedProblem("nbrdf_adam");
    if (options_.epochs) setup.options.schedule.max_iterations = *options_.epochs;
    return FitBy(std::move(setup), *AsInterpolated(material));
  }

  AnalyticBrdf Model(const Brdf& material) const {
    std::vector<BrdfSample> samples = TrainingMeasurements(material);
    if (samples.empty()) {
      samples = DrawSamples(material, SampleSet::kTraining, Sampling::kUniform, kModelSamples,
                            options_.seed);
    }
    AnalyticFitOptions options;
    options.lobes = 2;
    options.threads = options_.threads;
    return FitAnalytic(samples, material.IsIsotropic(), FindAnalyticModel("ggx"), options).brdf;
  }

  const Options& options_;
};

class Study {
 public:
  Study(const Options& options, const Scene& scene)
      : options_(options),
        scene_(scene),
        methods_(options),
        results_(kOurs, Quantities()),
        left_out_({"material", "angle", "reciprocal floor", "interpolation", "best estimate", kOurs,
                   "ratio"}) {}

  void Add(const MaterialSource& source) {
    const std::unique_ptr<Brdf> material = OpenBrdf(source.source);
    const std::vector<Candidate> candidates = methods_.Of(source, *material);
    AddErrors(source.name, *material, candidates);
    const bool is_list = !material->Measurements().empty();
    if (options_.pictures && !is_list) AddPictures(source, *material, candidates);
    if (options_.left_out) AddLeftOut(source.name, *material);
    std::fprintf(stderr, "%s: error at measured directions %s (floor %s), %s CPU s\n",
                 source.name.c_str(), Shown(kMeasured, source.name).c_str(),
                 Significant(results_.Value(kMeasured, source.name, kFloor), 3).c_str(),
                 Shown(kSeconds, source.name).c_str());
  }

  std::string Markdown() const {
    std::string text = "## Measured materials\n\n" + results_.Markdown();
    if (left_out_.rows().empty()) return text;
    std::size_t below = 0;
    for (double ratio : ratios_) below += ratio < 1.0;
    return text + StrCat("\n### Error at incident angles left out\n\n", left_out_.Markdown(),
                         "\nours over interpolation: median ", Significant(Median(ratios_), 3),
                         ", below 1 at ", below, " of ", ratios_.size(), " angles\n");
  }

 private:
  std::string Shown(const char* quantity, const std::string& material) const {
    return Significant(results_.Value(quantity, material, kOurs), 3);
  }

  void AddErrors(const std::string& name, const Brdf& material,
                 const std::vector<Candidate>& candidates) {
    const auto measured = SamplesAtMeasured(material, options_.samples);
    const auto all = HeldOutSamples(material, kHeldOut, kMeasureSeed);
    results_.Add(kMeasured, name, kFloor, MeasuredFloor(material, measured));
    results_.Add(
        kAlbedo, name, kItself,
        MeasureEnergy(material, {.last_angle = kLastMaterialAngle}).max_directional_albedo);
    for (const Candidate& candidate : candidates) {
      const std::unique_ptr<Brdf> fit = candidate.make();
      const auto add = [&](const char* quantity, double value) {
        results_.Add(quantity, name, candidate.method, value);
      };
      add(kMeasured, ErrorAt(measured, *fit));
      if (material.Measurements().empty()) add(kAll, ErrorAt(all, *fit));
      add(kAlbedo, MeasureEnergy(*fit).max_directional_albedo);
      add(kDeltaE, MeasureColorErrors(measured, *fit).delta_e_mean);
      if (!std::isnan(candidate.seconds)) add(kSeconds, candidate.seconds);
    }
  }

  void AddLeftOut(const std::string& name, const Brdf& material) {
    const std::vector<double> angles = material.IncidentAngles();
    const std::unique_ptr<Brdf> best = material.BestEstimate(Brdf::Estimate::kLikeliest);
    for (std::size_t k = 1; k + 1 < angles.size(); ++k) {
      const auto samples = SamplesAtAngle(material, angles[k], options_.samples);
      const std::unique_ptr<Brdf> rest = material.WithoutIncidentAngle(k);
      const std::unique_ptr<Brdf> estimate = rest->BestEstimate(Brdf::Estimate::kLikeliest);
      const double plain = ErrorAt(samples, *PlainInterpolation(*rest));
      const double ours = ErrorAt(samples, methods_.Ours(*rest));
      ratios_.push_back(ours / plain);
      left_out_.Add({name, Significant(angles[k] / kDegree, 3),
                     Significant(MeasuredFloor(best ? *best : material, samples), 3),
                     Significant(plain, 3),
                     Significant(ErrorAt(samples, estimate ? *estimate : *rest), 3),
                     Significant(ours, 3), Significant(ratios_.back(), 3)});
    }
  }

  void AddPictures(const MaterialSource& source, const Brdf& material,
                   const std::vector<Candidate>& candidates) {
    const Studio studio(scene_, material, options_.samples_per_pixel, options_.threads);
    const auto open = [&] { return OpenBrdf(source.source); };
    const auto symmetric = [&] { return std::make_unique<ReciprocalBrdf>(open()); };
    const auto target = [&] {
      std::unique_ptr<Brdf> best = material.BestEstimate(Brdf::Estimate::kLikeliest);
      return std::make_unique<ReciprocalBrdf>(best ? std::move(best) : open());
    };
    const Image itself = studio.Photograph(open), twin = studio.Photograph(symmetric);
    const Image aim = studio.Photograph(target);
    AddImage(source.name, kSymmetric, 0, CompareImages(itself, twin));
    for (const Candidate& candidate : candidates) {
      const Image image = studio.Photograph(candidate.make);
      AddImage(source.name, candidate.method, 0, CompareImages(itself, image));
      AddImage(source.name, candidate.method, 1, CompareImages(twin, image));
      if (candidate.method != kOurs) continue;
      results_.Add(kToTarget, source.name, kOurs, CompareImages(aim, image).psnr);
    }
  }

  void AddImage(const std::string& name, const std::string& method, int reference,
                const ImageErrors& errors) {
    const char* to = kReferences[reference];
    results_.Add(StrCat("PSNR", to, ", dB"), name, method, errors.psnr);
    results_.Add(StrCat("SSIM", to), name, method, errors.ssim);
    results_.Add(StrCat("FLIP", to), name, method, errors.flip);
  }

  const Options& options_;
  const Scene& scene_;
  const Methods methods_;
  Results results_;
  Table left_out_;
  std::vector<double> ratios_;  // of left_out_
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const Scene scene = ReadSmallScene(options.scene, options.environment, options.film_width);
  if (scene.materials.size() != 1) Fail(options.scene, ": must have one material");
  if (arguments.empty()) Fail("no materials: name some files of measurements");
  Study study(options, scene);
  for (const MaterialSource& source : ParseMaterials(arguments, {}, options.sgd)) study.Add(source);
  output.WriteReport("measured", study.Markdown());
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
