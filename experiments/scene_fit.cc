// scene_fit.cc: fits for a scene beside fits for all angles: image error against training samples.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>

#include "base/text.h"
#include "comparison.h"
#include "default_materials.h"
#include "experiment.h"
#include "fit_log.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/render/demand.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "small_scene.h"

DEFINE_string(scenes, "problems/scenes/sphere.json,problems/scenes/gallery.json",
              "scene files, separated by commas");
DEFINE_string(environment, "", "OpenEXR file in place of the scenes' own environment");
DEFINE_string(sgd, "", "CSV of SGD parameters, for materials sgd:NAME");
DEFINE_string(slot, "satin-gold",
              "the material that others take the place of in scenes that haven't got them");
DEFINE_uint64(samples, 12000,
              "training samples of fits for all angles; fits for the scene: a third");
DEFINE_string(seeds, "1,2,3", "seeds of the fits");
DEFINE_int32(film_width, 192, "of the images, in place of the scenes' own");
DEFINE_int32(samples_per_pixel, 64, "of the images");
DEFINE_double(scene_floor, pbnbrdf::FitProblem().asked_floor,
              "part of the samples that isn't the scene's");
DEFINE_double(max_seconds, 60.0, "of each fit");
DEFINE_int32(threads, 0, "0: one for each core");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(scene_fit: fits for a scene beside fits for all angles, by the error of the image.

  scene_fit --out_dir=results
  scene_fit --out_dir=results --scenes=problems/scenes/sphere.json --sgd=parameters.csv sgd:chrome-steel

The arguments are materials. Each is fitted in each scene: where the scene has it, or else in the
place of --slot, or of the only material. Images show one network, and all other materials as they
are. They are rendered along the same paths, so that they differ by the network alone. Each fit is a
row of scene_fit.csv as soon as it is done; scene_fit.md has the medians of the seeds.
)";

constexpr const char* kDefaultMaterials[] = {"builtin:satin-gold",
                                             "builtin:red-satin-plastic",
                                             "builtin:blue-plastic",
                                             "builtin:polished-chromium",
                                             "builtin:ivory-computer-plastic",
                                             "builtin:rough-iron",
                                             "builtin:glossy-grey-paper",
                                             "builtin:white-sand",
                                             "builtin:varnished-plywood"};

// What a fit draws its samples from, and what part of --samples.
struct Method {
  const char* name;
  Sampling sampling;
  bool for_scene;
  std::size_t divisor;
};

constexpr Method kMethods[] = {{"uniform", Sampling::kUniform, false, 1},
                               {"highlight / 3", Sampling::kHighlight, false, 3},
                               {"scene / 3", Sampling::kHighlight, true, 3}};
constexpr std::size_t kUniform = 0, kForScene = std::size(kMethods) - 1;

struct ImageError {
  double rmse, flip;
};

// How paths leave materials, by their source: of anisotropic ones it takes a second to find out.
using Proposals = std::map<std::string, LobeProposal>;

// A material in a scene, as it is and as networks have it.
class Case {
 public:
  // The proposals, which grow with the materials that paths get to, must outlive this.
  Case(Scene scene, Proposals& proposals, std::size_t slot, const std::string& source)
      : scene_(std::move(scene)),
        proposals_(proposals),
        slot_(slot),
        truth_(OpenBrdf(source)),
        proposal_(FitLobeProposal(*truth_)) {
    scene_.materials[slot_].source = kSlot;
    demand_ = MeasureDemand(scene_, Opener([&] { return OpenBrdf(source); }),
                            {.threads = FLAGS_threads})[slot_];
    if (!demand_.angles) Fail("the scene doesn't show it");
    reference_ = Image(Opener([&] { return OpenBrdf(source); }));
  }

  ImageError Run(const Method& method, std::size_t seed) const {
    FitProblem problem;
    problem.encoding = EncodingFor(*truth_);
    problem.sampling = method.sampling;
    problem.samples = std::max<std::size_t>(FLAGS_samples / method.divisor, 1);
    problem.seed = seed;
    if (method.for_scene) problem.asked = demand_.angles;
    problem.asked_floor = FLAGS_scene_floor;
    FitOptions options;
    options.threads = FLAGS_threads;
    options.max_seconds = FLAGS_max_seconds;
    const Fit fit = FitBrdf(*truth_, problem, options);
    const ImageErrors errors = CompareImages(
        reference_, Image(Opener([&] { return std::make_unique<NeuralBrdf>(fit.network); })));
    return {errors.rmse, errors.flip};
  }

  double share() const { return demand_.share; }

 private:
  static constexpr char kSlot[] = "the material";

  // Opens all materials as the scene says, but for the one, which sends paths its own way whatever
  // takes its place.
  template <typename Open>
  MaterialOpener Opener(Open open) const {
    return [this, open](const std::string& source) -> OpenedMaterial {
      if (source == kSlot) return {open(), proposal_};
      std::unique_ptr<Brdf> brdf = OpenBrdf(source);
      auto known = proposals_.find(source);
      if (known == proposals_.end()) {
        known = proposals_.emplace(source, FitLobeProposal(*brdf)).first;
      }
      return {std::move(brdf), known->second};
    };
  }

  pbnbrdf::Image Image(const MaterialOpener& open) const {
    RenderOptions options;
    options.samples_per_pixel = FLAGS_samples_per_pixel;
    options.threads = FLAGS_threads;
    return Render(scene_, open, options).image;
  }

  Scene scene_;
  Proposals& proposals_;
  std::size_t slot_;
  std::unique_ptr<Brdf> truth_;
  LobeProposal proposal_;
  MaterialDemand demand_;
  pbnbrdf::Image reference_;
};

// The seeds' medians, of each method.
struct Row {
  std::string scene, material;
  double share;
  std::vector<ImageError> errors;
};

// Where the material goes.
std::size_t SlotOf(const Scene& scene, const std::string& source) {
  if (scene.materials.size() == 1) return 0;
  const auto find = [&](auto has) {
    return std::size_t(std::find_if(scene.materials.begin(), scene.materials.end(), has) -
                       scene.materials.begin());
  };
  std::size_t slot = find([&](const SceneMaterial& m) { return m.source == source; });
  if (slot == scene.materials.size()) {
    slot = find([](const SceneMaterial& m) { return m.name == FLAGS_slot; });
  }
  if (slot == scene.materials.size()) Fail("slot: the scene has no material '", FLAGS_slot, "'");
  return slot;
}

Row RunCase(const Case& one, const std::string& scene, const std::string& material, FitLog* log) {
  Row row = {scene, material, one.share(), {}};
  for (const Method& method : kMethods) {
    std::vector<double> rmse, flip;
    for (const std::size_t seed : ParseCounts("seeds", FLAGS_seeds)) {
      const ImageError error = one.Run(method, seed);
      log->AddRow({scene, material, method.name, StrCat(FLAGS_samples / method.divisor),
                   StrCat(seed), FormatNumber(error.rmse), FormatNumber(error.flip)});
      rmse.push_back(error.rmse);
      flip.push_back(error.flip);
    }
    row.errors.push_back({Median(rmse), Median(flip)});
    std::fprintf(stderr, "%s, %s, %s: RMSE %.3g, FLIP %.3g\n", scene.c_str(), material.c_str(),
                 method.name, row.errors.back().rmse, row.errors.back().flip);
  }
  return row;
}

std::string Markdown(const std::vector<Row>& rows) {
  std::vector<std::string> titles = {"scene", "material", "share"};
  for (const Method& method : kMethods) titles.push_back(StrCat(method.name, ": RMSE, FLIP"));
  titles.push_back("for the scene / uniform: RMSE");
  titles.push_back("FLIP");
  Table table(titles);
  std::vector<double> rmse_ratios, flip_ratios;
  for (const Row& row : rows) {
    std::vector<std::string> cells = {row.scene, row.material, Significant(row.share, 2)};
    for (const ImageError& error : row.errors) {
      cells.push_back(StrCat(Significant(error.rmse, 3), ", ", Significant(error.flip, 3)));
    }
    const ImageError &uniform = row.errors[kUniform], &for_scene = row.errors[kForScene];
    rmse_ratios.push_back(for_scene.rmse / uniform.rmse);
    flip_ratios.push_back(for_scene.flip / uniform.flip);
    cells.push_back(Significant(rmse_ratios.back(), 2));
    cells.push_back(Significant(flip_ratios.back(), 2));
    table.Add(cells);
  }
  std::vector<std::string> median(titles.size()), worst(titles.size());
  median[0] = "**median**";
  worst[0] = "**worst**";
  const auto summarize = [&](std::size_t column, const std::vector<double>& ratios) {
    median[column] = Significant(Median(ratios), 2);
    worst[column] = Significant(*std::max_element(ratios.begin(), ratios.end()), 2);
  };
  summarize(titles.size() - 2, rmse_ratios);
  summarize(titles.size() - 1, flip_ratios);
  table.Add(median);
  table.Add(worst);
  return table.Markdown();
}

void Run(const std::vector<std::string>& arguments) {
  if (FLAGS_samples < 3) Fail("samples = ", FLAGS_samples, "; must be >= 3");
  std::vector<std::string> texts = arguments;
  if (texts.empty()) texts = {std::begin(kDefaultMaterials), std::end(kDefaultMaterials)};
  for (std::string& text : texts) text = WithSgdPath(text, FLAGS_sgd);
  const std::vector<MaterialSource> materials = ParseMaterials(texts);
  FitLog log(OutputPath("scene_fit.csv"),
             {"scene", "material", "method", "samples", "seed", "rmse", "flip"});
  std::vector<Row> rows;
  for (const std::string& path : Split(FLAGS_scenes, ',')) {
    const Scene scene = ReadSmallScene(path, FLAGS_environment, FLAGS_film_width);
    Proposals proposals;
    const std::string name = std::filesystem::path(path).stem();
    for (const MaterialSource& material : materials) {
      const std::size_t slot = SlotOf(scene, material.source);
      rows.push_back(
          RunCase(Case(scene, proposals, slot, material.source), name, material.name, &log));
    }
  }
  WriteReport("scene_fit",
              StrCat(FLAGS_samples, " training samples, or a third; seeds ", FLAGS_seeds,
                     "; images ", FLAGS_film_width, " pixels wide, ", FLAGS_samples_per_pixel,
                     " samples a pixel.\n\n", Markdown(rows)));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}
