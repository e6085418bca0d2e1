// picture.cc: what errors of fits look like: a sphere with a material, with the published recipe's
// network, and with ours.
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

#include "experiment.h"
#include "materials.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "picture_grid.h"
#include "problems.h"
#include "render/studio.h"
#include "small_scene.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(picture: a sphere with a material, with the published recipe's network, and with ours.

  picture --out_dir=results
  picture --out_dir=results --sgd=parameters.csv --environment=studio.exr sgd:chrome-steel

The arguments are materials; without any, two built-in ones. picture.png has a row for each: the
material, the published network (--networks=DIR, DIR/NAME.h5) or else that of the published recipe
(problems/nbrdf_adam.flags, fitted by our own Adam), ours (the default problem), and the FLIP error maps
of the two. picture.md has the numbers. All images of a row follow the same paths, so that they differ
by the networks alone.
)" + std::string(kMaterialsHelp);

const Arguments kDefaultMaterials = {"builtin:red-satin-plastic", "builtin:polished-chromium"};

struct Options {
  std::string scene = "problems/scenes/sphere.json", environment, networks;
  int film_width = 256, samples_per_pixel = 256;
  std::optional<int> epochs;
  double max_seconds = 60.0, max_flip = 0.2;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string sgd;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Text("scene", &o->scene, "scene file, of one material"));
  fields.Add(Text("environment", &o->environment,
                  "OpenEXR file that takes the place of the scene's environment light"));
  fields.Add(Text("networks", &o->networks, "folder of published networks, NAME.h5"));
  fields.Add(Integer("film_width", &o->film_width, AtLeast(kSsimWindow), "pixels of each image"));
  fields.Add(Integer("samples_per_pixel", &o->samples_per_pixel, AtLeast(1), "of each image"));
  fields.Add(OverridingInteger("epochs", &o->epochs, AtLeast(0), "epochs of the published recipe"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each of our fits"));
  fields.Add(
      Number("max_flip", &o->max_flip, Above(0.0), "FLIP that the error maps show as white"));
  fields.Add(Integer("seed", &o->seed, AtLeast(0), "of the fits"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "0: one for each core"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

struct FittedNetwork {
  NeuralBrdf network;
  double seconds;
};

FittedNetwork Fitted(const Brdf& material, FitSetup setup, const Options& options) {
  setup.problem.sampling.seed = options.seed;
  setup.options.threads = options.threads;
  const Fit fit = FitBrdf(material, setup.problem, setup.options);
  return {fit.network, fit.summary.seconds};
}

FittedNetwork FitPublished(const Brdf& material, const Options& options) {
  FitSetup setup = ShippedProblem("nbrdf_adam");
  if (options.epochs) setup.options.schedule.max_iterations = *options.epochs;
  return Fitted(material, setup, options);
}

FittedNetwork FitOurs(const Brdf& material, const Options& options) {
  FitSetup setup;
  setup.options.schedule.max_seconds = options.max_seconds;
  return Fitted(material, setup, options);
}

void AddRow(const std::string& material, const char* method, double seconds,
            const ImageErrors& errors, Table* table) {
  table->Add({material, method, Significant(seconds, 2), Significant(errors.rmse, 2),
              Significant(errors.psnr, 3), Significant(errors.ssim, 5), Significant(errors.flip, 2),
              Significant(errors.delta_e_2000, 2)});
}

// A row of the picture, and two of the table.
void AddMaterial(const Scene& scene, const MaterialSource& source, const Options& options,
                 PictureGrid* grid, Table* table) {
  const std::unique_ptr<Brdf> material = OpenBrdf(source.source);
  const Studio studio(scene, *material, options.samples_per_pixel, options.threads);
  const Image reference = studio.Photograph([&] { return OpenBrdf(source.source); });
  const double exposure = DisplayExposure(reference);
  const Image shown = Exposed(reference, exposure);
  grid->Add(source.name, shown);
  std::vector<std::pair<std::string, Image>> maps;
  const auto add = [&](const char* method, const FittedNetwork& fit) {
    const Image image =
        studio.Photograph([&] { return std::make_unique<NeuralBrdf>(fit.network); });
    const ImageErrors errors = CompareImages(reference, image);
    AddRow(source.name, method, fit.seconds, errors, table);
    const Image exposed = Exposed(image, exposure);
    grid->Add(StrCat(method, ", ", Significant(errors.psnr, 3), " dB"), exposed);
    maps.push_back({StrCat("FLIP of the ", method, ": ", Significant(errors.flip, 2)),
                    FlipPicture(shown, exposed, options.max_flip)});
    std::fprintf(stderr, "%s, %s: %.3g s\n", source.name.c_str(), method, fit.seconds);
  };
  const std::string published = options.networks + "/" + source.name + ".h5";
  if (!options.networks.empty() && IsMeasurement(source) && std::filesystem::exists(published)) {
    add("published network", {OpenNetwork(published), std::numeric_limits<double>::quiet_NaN()});
  } else {
    add("published recipe", FitPublished(*material, options));
  }
  add("fit", FitOurs(*material, options));
  for (const auto& [label, map] : maps) grid->Add(label, map);
}

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const Scene scene = ReadSmallScene(options.scene, options.environment, options.film_width);
  if (scene.materials.size() != 1) Fail(options.scene, ": must have one material");
  Table table(
      {"material", "network", "fit, s", "RMSE", "PSNR, dB", "SSIM", "FLIP", "Delta E 2000"});
  PictureGrid grid(5);
  for (const MaterialSource& material : ParseMaterials(arguments, kDefaultMaterials, options.sgd)) {
    AddMaterial(scene, material, options, &grid, &table);
  }
  if (const std::string why = grid.Write(output.Path("picture.png")); !why.empty()) {
    std::fprintf(stderr, "picture.png has %s\n", why.c_str());
  }
  output.WriteReport("picture", StrCat("Left to right: the material, the published network or "
                                       "recipe's, our fit, FLIP of the two from 0 "
                                       "(black) to ",
                                       options.max_flip, " (white).\n\n", table.Markdown()));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
