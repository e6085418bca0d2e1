// picture.cc: what errors of fits look like: a sphere with a material, with the published recipe's
// network, and with ours.
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <iterator>

#include "base/text.h"
#include "comparison.h"
#include "default_materials.h"
#include "experiment.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/metrics/flip.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/render/render.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "small_scene.h"

DEFINE_string(scene, "problems/scenes/sphere.json", "a scene of one material");
DEFINE_string(environment, "", "OpenEXR file in place of the scene's environment light");
DEFINE_string(sgd, "", "CSV of SGD parameters, for materials sgd:NAME");
DEFINE_int32(film_width, 256, "of each image");
DEFINE_int32(samples_per_pixel, 256, "of each image");
DEFINE_int32(epochs, 100, "of the published recipe");
DEFINE_double(max_seconds, 60.0, "of our fits");
DEFINE_double(largest_flip, 0.2, "what the error maps show as white");
DEFINE_uint64(seed, 1, "of the fits");
DEFINE_int32(threads, 0, "0: one for each core");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(picture: a sphere with a material, with the published recipe's network, and with ours.

  picture --out_dir=results
  picture --out_dir=results --sgd=parameters.csv --environment=studio.exr sgd:chrome-steel

The arguments are materials. picture.png has a row for each: the material, the network of the
published recipe (problems/nbrdf_adam.flags, solved by our own Adam), ours (the default problem), and
the FLIP error maps of the two. picture.md has the numbers. All images of a row follow the same
paths, so that they differ by the networks alone.
)";

constexpr const char* kDefaultMaterials[] = {"builtin:red-satin-plastic",
                                             "builtin:polished-chromium"};

struct FittedNetwork {
  NeuralBrdf network;
  double seconds;
};

FittedNetwork FitPublished(const Brdf& material) {
  FitProblem problem;
  problem.encoding = Encoding::kCartesian;
  problem.activation = Activation::kRelu;
  problem.initialization = Initialization::kNbrdf;
  problem.energy_weight = 0.0;
  problem.sampling = Sampling::kUniform;
  problem.samples = 640000;
  problem.seed = FLAGS_seed;
  FitOptions options;
  options.solver = Solver::kAdam;
  options.max_iterations = FLAGS_epochs;
  options.threads = FLAGS_threads;
  const Fit fit = FitBrdf(material, problem, options);
  return {fit.network, fit.summary.seconds};
}

FittedNetwork FitOurs(const Brdf& material) {
  FitProblem problem;
  problem.encoding = EncodingFor(material);
  problem.seed = FLAGS_seed;
  FitOptions options;
  options.max_seconds = FLAGS_max_seconds;
  options.threads = FLAGS_threads;
  const Fit fit = FitBrdf(material, problem, options);
  return {fit.network, fit.summary.seconds};
}

// Black over red and yellow to white.
std::array<float, 3> Heat(double value) {
  const auto part = [&](double from) {
    return static_cast<float>(std::clamp(3.0 * value - from, 0.0, 1.0));
  };
  return {part(0.0), part(1.0), part(2.0)};
}

Image ErrorMap(const Image& reference, const Image& test) {
  const std::vector<double> flip = FlipMap(reference, test);
  Image map(reference.width, reference.height);
  for (std::size_t i = 0; i < flip.size(); ++i) {
    const auto color = Heat(flip[i] / FLAGS_largest_flip);
    std::copy(color.begin(), color.end(), map.rgb.begin() + std::ptrdiff_t(3 * i));
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

// Renders the scene with whatever takes the material's place, along the paths that suit the material.
class Studio {
 public:
  Studio(const Scene& scene, const Brdf& material)
      : scene_(scene), proposal_(FitLobeProposal(material)) {}

  Image Photograph(const std::function<std::unique_ptr<Brdf>()>& make) const {
    RenderOptions options;
    options.samples_per_pixel = FLAGS_samples_per_pixel;
    options.threads = FLAGS_threads;
    const auto open = [&](const std::string&) { return OpenedMaterial{make(), proposal_}; };
    return Render(scene_, open, options).image;
  }

 private:
  const Scene& scene_;
  LobeProposal proposal_;
};

// A row of the picture, and two of the table.
Image RunMaterial(const Scene& scene, const MaterialSource& source, Table* table) {
  const std::unique_ptr<Brdf> material = OpenBrdf(source.source);
  const Studio studio(scene, *material);
  const Image reference = studio.Photograph([&] { return OpenBrdf(source.source); });
  const double exposure = DisplayExposure(reference);
  const Image exposed_reference = Exposed(reference, exposure);
  std::vector<Image> images = {exposed_reference}, maps;
  const auto add = [&](const char* method, const FittedNetwork& fit) {
    const Image image =
        studio.Photograph([&] { return std::make_unique<NeuralBrdf>(fit.network); });
    AddRow(source.name, method, fit.seconds, CompareImages(reference, image), table);
    images.push_back(Exposed(image, exposure));
    maps.push_back(ErrorMap(exposed_reference, images.back()));
    std::fprintf(stderr, "%s, %s: %.3g s\n", source.name.c_str(), method, fit.seconds);
  };
  add("published recipe", FitPublished(*material));
  add("ours", FitOurs(*material));
  images.insert(images.end(), maps.begin(), maps.end());
  return Beside(images);
}

void Run(const std::vector<std::string>& arguments) {
  if (!(FLAGS_largest_flip > 0.0)) Fail("largest_flip must be > 0");
  std::vector<std::string> texts = arguments;
  if (texts.empty()) texts = {std::begin(kDefaultMaterials), std::end(kDefaultMaterials)};
  for (std::string& text : texts) text = WithSgdPath(text, FLAGS_sgd);
  const Scene scene = ReadSmallScene(FLAGS_scene, FLAGS_environment, FLAGS_film_width);
  if (scene.materials.size() != 1) Fail(FLAGS_scene, ": must have one material");
  Table table(
      {"material", "network", "fit, s", "RMSE", "PSNR, dB", "SSIM", "FLIP", "Delta E 2000"});
  std::vector<Image> rows;
  for (const MaterialSource& material : ParseMaterials(texts)) {
    rows.push_back(RunMaterial(scene, material, &table));
  }
  WritePng(OutputPath("picture.png"), Below(rows));
  WriteReport(
      "picture",
      StrCat("Left to right: the material, the published recipe's network, ours, FLIP of the "
             "two from 0 (black) to ",
             FLAGS_largest_flip, " (white).\n\n", table.Markdown()));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}
