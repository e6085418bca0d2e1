// measured.cc: fits of real measurements: at what was measured, at angles that were left out, and as
// pictures.
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <random>

#include "curves.h"
#include "experiment.h"
#include "materials.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/reciprocal.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "pbnbrdf/sources/rgl.h"
#include "problems.h"
#include "small_scene.h"
#include "studio.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(measured: fits of real measurements, RGL files: at what was measured, at incident angles that
were left out of the fit, and as pictures.

  measured --out_dir=results --networks=nbrdf rgl/chm_mint_rgb.bsdf rgl/paper_white_rgb.bsdf ...

The arguments are files of the RGL material database. --networks is a folder of networks that others
have fitted to the same materials, NAME.h5 for NAME.bsdf.
)";

struct Options {
  std::string networks, scene = "problems/scenes/sphere.json", environment;
  bool left_out = true, pictures = true;
  int film_width = 256, samples_per_pixel = 64, threads = 0;
  std::uint64_t samples = 4000, seed = 1;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Text("networks", &o->networks, "folder of published networks, NAME.h5"));
  fields.Add(Text("scene", &o->scene, "scene file, of one material"));
  fields.Add(Text("environment", &o->environment,
                  "OpenEXR file that takes the place of the scene's environment light"));
  fields.Add(Switch("left_out", &o->left_out, "fit without each interior incident angle in turn"));
  fields.Add(Switch("pictures", &o->pictures, "render pictures"));
  fields.Add(Integer("film_width", &o->film_width, AtLeast(kSsimWindow), "pixels of each picture"));
  fields.Add(Integer("samples_per_pixel", &o->samples_per_pixel, AtLeast(1), "of each picture"));
  fields.Add(Integer("samples", &o->samples, AtLeast(1),
                     "directions at each incident angle, to measure errors at"));
  fields.Add(Integer("seed", &o->seed, AtLeast(0), "of the fits"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "0: one for each core"));
  return fields;
}

constexpr std::uint64_t kMeasureSeed = 1;
constexpr std::size_t kHeldOut = 50000;

double ErrorAt(const std::vector<BrdfSample>& samples, const Brdf& fit) {
  return MeasureErrors(samples, fit).mean_abs_log_error;
}

// Samples at an incident angle: theta_h uniform up to 90 degrees, as in eq. 6, and any azimuth.
std::vector<BrdfSample> SamplesAtAngle(const Brdf& material, double theta_i, std::size_t count) {
  std::mt19937_64 random(kMeasureSeed);
  const auto uniform = [&] { return (static_cast<double>(random() >> 32) + 0.5) * 0x1p-32; };
  const Vec3 wi = FromSpherical(theta_i, 0.0);
  std::vector<DirectionPair> pairs;
  while (pairs.size() < count) {
    const double theta_h = 0.5 * std::numbers::pi * uniform();
    const Vec3 h = FromSpherical(theta_h, 2.0 * std::numbers::pi * uniform());
    const DirectionPair pair = {wi, 2.0 * Dot(wi, h) * h - wi};
    if (material.IsKnown(pair)) pairs.push_back(pair);
  }
  return SamplesAt(material, pairs);
}

// At all measured angles that the material is known at.
std::vector<BrdfSample> SamplesAtAngles(const RglBrdf& material, std::size_t count) {
  std::vector<BrdfSample> all;
  for (double theta_i : material.IncidentAngles()) {
    const Vec3 wi = FromSpherical(theta_i, 0.0);
    if (!material.IsKnown({wi, {0.0, 0.0, 1.0}})) continue;
    const auto samples = SamplesAtAngle(material, theta_i, count);
    all.insert(all.end(), samples.begin(), samples.end());
  }
  return all;
}

class Study {
 public:
  Study(const Options& options, const Scene& scene)
      : options_(options),
        scene_(scene),
        errors_({"material", "measured: published", "ours", "all: published", "ours", "max albedo",
                 "s"}),
        left_out_({"material", "angle", "reciprocal floor", "RGL's interpolation", "best estimate",
                   "ours", "ratio"}),
        pictures_({"material", "symmetric", "published", "ours", "FLIP: published", "ours",
                   "ours to target"}) {}

  void Add(const std::string& source) {
    const std::string name = std::filesystem::path(source).stem().string();
    const RglBrdf material = RglBrdf::Read(source);
    std::unique_ptr<Brdf> published;
    if (!options_.networks.empty()) {
      published = OpenBrdf(options_.networks + "/" + name + ".h5");
    }
    const Fit fit = FitTo(material);
    AddErrors(name, material, published.get(), fit);
    if (options_.pictures) AddPictures(name, material, published.get(), fit.network);
    if (options_.left_out) AddLeftOut(name, material);
    std::fprintf(stderr, "%s", errors_.Markdown().c_str());
    std::fprintf(stderr, "%s", pictures_.Markdown().c_str());
  }

  std::string Markdown() const {
    return StrCat(errors_.Markdown(), "\n", left_out_.Markdown(), "\n", pictures_.Markdown(),
                  "\nmedian ratio at measured ", Median(measured_ratios_), ", left out ",
                  Median(left_out_ratios_), ", of their errors ", Median(left_out_errors_),
                  ", PSNR ", Median(psnrs_), " dB, above published by ", Median(psnr_gains_),
                  " dB, to target ", Median(target_psnrs_), " dB\n");
  }

 private:
  Fit FitTo(const Brdf& material) const {
    FitSetup setup;
    setup.problem.sampling.seed = options_.seed;
    setup.options.threads = options_.threads;
    return FitBrdf(material, setup.problem, setup.options);
  }

  void AddErrors(const std::string& name, const RglBrdf& material, const Brdf* published,
                 const Fit& fit) {
    const auto at_measured = SamplesAtAngles(material, options_.samples);
    const auto all = HeldOutSamples(material, kHeldOut, kMeasureSeed);
    const double ours = ErrorAt(at_measured, fit.network);
    const double theirs = published ? ErrorAt(at_measured, *published) : NAN;
    measured_ratios_.push_back(ours / theirs);
    errors_.Add({name, Significant(theirs, 3), Significant(ours, 3),
                 Significant(published ? ErrorAt(all, *published) : NAN, 3),
                 Significant(ErrorAt(all, fit.network), 3),
                 Significant(fit.summary.energy.max_albedo, 4),
                 Significant(fit.summary.seconds, 2)});
  }

  void AddLeftOut(const std::string& name, const RglBrdf& material) {
    const std::vector<double> angles = material.IncidentAngles();
    for (std::size_t k = 1; k + 1 < angles.size(); ++k) {
      const RglBrdf rest = material.WithoutIncidentAngle(k);
      const auto samples = SamplesAtAngle(material, angles[k], options_.samples);
      const Fit fit = FitTo(rest);
      const double theirs = ErrorAt(samples, rest), ours = ErrorAt(samples, fit.network);
      left_out_ratios_.push_back(ours / theirs);
      left_out_errors_.push_back(ours);
      left_out_.Add({name, Significant(angles[k] * 180.0 / std::numbers::pi, 3),
                     Significant(ReciprocalFloor(samples, *material.BestEstimate()), 3),
                     Significant(theirs, 3), Significant(ErrorAt(samples, *rest.BestEstimate()), 3),
                     Significant(ours, 3), Significant(ours / theirs, 3)});
    }
  }

  void AddPictures(const std::string& name, const RglBrdf& material, const Brdf* published,
                   const NeuralBrdf& network) {
    const Studio studio(scene_, material, options_.samples_per_pixel, options_.threads);
    const auto copy = [](const RglBrdf& brdf) { return std::make_unique<RglBrdf>(brdf); };
    const Image reference = studio.Photograph([&] { return copy(material); });
    const Image symmetric =
        studio.Photograph([&] { return std::make_unique<ReciprocalBrdf>(copy(material)); });
    const Image target = studio.Photograph(
        [&] { return std::make_unique<ReciprocalBrdf>(material.BestEstimate()); });
    const Image ours = studio.Photograph([&] { return std::make_unique<NeuralBrdf>(network); });
    const ImageErrors of_ours = CompareImages(reference, ours);
    ImageErrors of_theirs = {};
    if (published) {
      const std::string path = options_.networks + "/" + name + ".h5";
      of_theirs = CompareImages(reference, studio.Photograph([&] { return OpenBrdf(path); }));
    }
    psnrs_.push_back(of_ours.psnr);
    psnr_gains_.push_back(of_ours.psnr - of_theirs.psnr);
    target_psnrs_.push_back(CompareImages(target, ours).psnr);
    pictures_.Add({name, Significant(CompareImages(reference, symmetric).psnr, 3),
                   Significant(of_theirs.psnr, 3), Significant(of_ours.psnr, 3),
                   Significant(of_theirs.flip, 3), Significant(of_ours.flip, 3),
                   Significant(target_psnrs_.back(), 3)});
  }

  const Options& options_;
  const Scene& scene_;
  Table errors_, left_out_, pictures_;
  std::vector<double> measured_ratios_, left_out_ratios_, left_out_errors_, psnrs_, psnr_gains_,
      target_psnrs_;
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const Scene scene = ReadSmallScene(options.scene, options.environment, options.film_width);
  if (scene.materials.size() != 1) Fail(options.scene, ": must have one material");
  Study study(options, scene);
  for (const std::string& source : arguments) study.Add(source);
  output.WriteReport("measured", study.Markdown());
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
