// picture.cc: what errors of fits look like: a sphere with a material, with the published recipe's
// network, and with ours.
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "experiment.h"
#include "materials.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/metrics/flip.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/sources/open_brdf.h"
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
material, the network of the published recipe (problems/nbrdf_adam.flags, fitted by our own Adam), ours
(the default problem), and the FLIP error maps of the two. picture.md has the numbers. All images of a
row follow the same paths, so that they differ by the networks alone.
)" + std::string(kMaterialsHelp);

const Arguments kDefaultMaterials = {"builtin:red-satin-plastic", "builtin:polished-chromium"};

struct Options {
  std::string scene = "problems/scenes/sphere.json", environment;
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

// Black over red and yellow to white.
std::array<float, 3> Heat(double value) {
  const auto part = [&](double from) {
    return static_cast<float>(std::clamp(3.0 * value - from, 0.0, 1.0));
  };
  return {part(0.0), part(1.0), part(2.0)};
}

Image ErrorMap(const Image& reference, const Image& test, double max_flip) {
  const std::vector<double> flip = FlipMap(reference, test);
  Image map(reference.width, reference.height);
  for (std::size_t i = 0; i < flip.size(); ++i) {
    const auto color = Heat(flip[i] / max_flip);
    std::copy(color.begin(), color.end(), map.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return map;
}

// Images of one size side by side.
Image Beside(const std::vector<Image>& images) {
  const int width = images[0].width, height = images[0].height;
  Image all(width * static_cast<int>(images.size()), height);
  for (int y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      const float* row = images[i].pixel(0, y);
      std::copy(row, row + 3 * width, all.pixel(static_cast<int>(i) * width, y));
    }
  }
  return all;
}

// Images of one width, one below the other.
Image Below(const std::vector<Image>& images) {
  Image all(images[0].width, static_cast<int>(images.size()) * images[0].height);
  all.rgb.clear();
  for (const Image& image : images) {
    all.rgb.insert(all.rgb.end(), image.rgb.begin(), image.rgb.end());
  }
  return all;
}

void AddRow(const std::string& material, const char* method, double seconds,
            const ImageErrors& errors, Table* table) {
  table->Add({material, method, Significant(seconds, 2), Significant(errors.rmse, 2),
              Significant(errors.psnr, 3), Significant(errors.ssim, 5), Significant(errors.flip, 2),
              Significant(errors.delta_e_2000, 2)});
}

Image Exposed(Image image, double exposure) {
  for (float& value : image.rgb) value = static_cast<float>(exposure * value);
  return image;
}

// A row of the picture, and two of the table.
Image RunMaterial(const Scene& scene, const MaterialSource& source, const Options& options,
                  Table* table) {
  const std::unique_ptr<Brdf> material = OpenBrdf(source.source);
  const Studio studio(scene, *material, options.samples_per_pixel, options.threads);
  const Image reference = studio.Photograph([&] { return OpenBrdf(source.source); });
  const double exposure = DisplayExposure(reference);
  const Image exposed_reference = Exposed(reference, exposure);
  std::vector<Image> images = {exposed_reference}, maps;
  const auto add = [&](const char* method, const FittedNetwork& fit) {
    const Image image =
        studio.Photograph([&] { return std::make_unique<NeuralBrdf>(fit.network); });
    AddRow(source.name, method, fit.seconds, CompareImages(reference, image), table);
    images.push_back(Exposed(image, exposure));
    maps.push_back(ErrorMap(exposed_reference, images.back(), options.max_flip));
    std::fprintf(stderr, "%s, %s: %.3g s\n", source.name.c_str(), method, fit.seconds);
  };
  add("published recipe", FitPublished(*material, options));
  add("ours", FitOurs(*material, options));
  images.insert(images.end(), maps.begin(), maps.end());
  return Beside(images);
}

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const Scene scene = ReadSmallScene(options.scene, options.environment, options.film_width);
  if (scene.materials.size() != 1) Fail(options.scene, ": must have one material");
  Table table(
      {"material", "network", "fit, s", "RMSE", "PSNR, dB", "SSIM", "FLIP", "Delta E 2000"});
  std::vector<Image> rows;
  for (const MaterialSource& material : ParseMaterials(arguments, kDefaultMaterials, options.sgd)) {
    rows.push_back(RunMaterial(scene, material, options, &table));
  }
  WritePng(output.Path("picture.png"), Below(rows));
  output.WriteReport(
      "picture",
      StrCat("Left to right: the material, the published recipe's network, ours, FLIP of the "
             "two from 0 (black) to ",
             options.max_flip, " (white).\n\n", table.Markdown()));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
