// scene_fit.cc: fits for a scene beside fits for all angles: image error against training samples.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>

#include "base/median.h"
#include "base/text.h"
#include "experiment.h"
#include "fit_log.h"
#include "materials.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/render/demand.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "small_scene.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(scene_fit: fits for a scene beside fits for all angles, by the error of the image.

  scene_fit --out_dir=results
  scene_fit --out_dir=results --scenes=problems/scenes/sphere.json --sgd=parameters.csv sgd:chrome-steel

The arguments are materials; without any, a few built-in ones. Each is fitted in each scene. Where the
scene doesn't have it, it takes the place of the material named by --slot, or of the only one. Images
show one network, and all other materials as they are. They follow the same paths, so that they differ
by the network alone. Each fit is a row of scene_fit.csv as soon as it is done; scene_fit.md has the
medians of the seeds.
)" + std::string(kMaterialsHelp);

const Arguments kDefaultMaterials = {"builtin:satin-gold",
                                     "builtin:red-satin-plastic",
                                     "builtin:blue-plastic",
                                     "builtin:polished-chromium",
                                     "builtin:ivory-computer-plastic",
                                     "builtin:rough-iron",
                                     "builtin:glossy-grey-paper",
                                     "builtin:white-sand",
                                     "builtin:varnished-plywood"};

struct Options {
  std::vector<std::string> scenes = {"problems/scenes/sphere.json", "problems/scenes/gallery.json"};
  std::string environment, slot = "satin-gold";
  std::uint64_t samples = 12000;
  std::vector<int> seeds = {1, 2, 3};
  int film_width = 192, samples_per_pixel = 64;
  double scene_floor = SamplingOptions{}.asked_floor, max_seconds = 60.0;
  int threads = 0;
  std::string sgd;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Texts("scenes", &o->scenes, "scene files"));
  fields.Add(Text("environment", &o->environment,
                  "OpenEXR file that takes the place of the scenes' environment light"));
  fields.Add(Text("slot", &o->slot,
                  "the scene's material whose place is taken by one that the scene doesn't have"));
  fields.Add(Integer("samples", &o->samples, AtLeast(3),
                     "training samples of uniform fits for all angles; the others have a third"));
  fields.Add(Integers("seeds", &o->seeds, AtLeast(1), "seeds of the fits"));
  fields.Add(Integer("film_width", &o->film_width, AtLeast(kSsimWindow), "pixels of each image"));
  fields.Add(Integer("samples_per_pixel", &o->samples_per_pixel, AtLeast(1), "of each image"));
  fields.Add(Number("scene_floor", &o->scene_floor, Between(0.0, 1.0),
                    "part of a scene fit's samples that is drawn from all angles all the same"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each fit"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "0: one for each core"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

// What a fit draws its samples from, and the number of them, --samples over `divisor`.
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

// How paths leave materials, by their source: found out once for each.
using Proposals = std::map<std::string, Proposal>;

// A material in a scene: the image of the material itself, and those of networks in its place.
class Case {
 public:
  // options and the proposals, which grow with the materials that paths get to, must outlive this.
  Case(const Options& options, Scene scene, Proposals& proposals, std::size_t slot,
       const std::string& source)
      : options_(options),
        scene_(std::move(scene)),
        proposals_(proposals),
        slot_(slot),
        truth_(OpenBrdf(source)),
        proposal_(FitProposal(*truth_)) {
    scene_.materials[slot_].source = kSlot;
    demand_ = MeasureDemand(scene_, Opener([&] { return OpenBrdf(source); }),
                            {.threads = options_.threads})[slot_];
    if (!demand_.angles) Fail("the scene doesn't show it");
    reference_ = Image(Opener([&] { return OpenBrdf(source); }));
  }

  ImageError Run(const Method& method, std::uint64_t seed) const {
    FitProblem problem;
    SamplingOptions* sampling = &problem.sampling;
    sampling->angles = method.sampling;
    sampling->samples = options_.samples / method.divisor;
    sampling->seed = seed;
    if (method.for_scene) sampling->asked = demand_.angles;
    sampling->asked_floor = options_.scene_floor;
    FitOptions options;
    options.threads = options_.threads;
    options.schedule.max_seconds = options_.max_seconds;
    const Fit fit = FitBrdf(*truth_, problem, options);
    const ImageErrors errors = CompareImages(
        reference_, Image(Opener([&] { return std::make_unique<NeuralBrdf>(fit.network); })));
    return {errors.rmse, errors.flip};
  }

  double share() const { return demand_.share; }

 private:
  static constexpr char kSlot[] = "the material";

  // Opens all materials as the scene says, and the one of this case with `open`. Paths leave that one in
  // the same ways whatever takes its place.
  template <typename Open>
  MaterialOpener Opener(Open open) const {
    return [this, open](const std::string& source) -> OpenedMaterial {
      if (source == kSlot) return {open(), proposal_};
      std::unique_ptr<Brdf> brdf = OpenBrdf(source);
      auto known = proposals_.find(source);
      if (known == proposals_.end()) {
        known = proposals_.emplace(source, FitProposal(*brdf)).first;
      }
      return {std::move(brdf), known->second};
    };
  }

  pbnbrdf::Image Image(const MaterialOpener& open) const {
    RenderOptions options;
    options.samples_per_pixel = options_.samples_per_pixel;
    options.threads = options_.threads;
    return Render(scene_, open, options).image;
  }

  const Options& options_;
  Scene scene_;
  Proposals& proposals_;
  std::size_t slot_;
  std::unique_ptr<Brdf> truth_;
  Proposal proposal_;
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
std::size_t SlotOf(const Scene& scene, const std::string& source, const std::string& default_slot) {
  if (scene.materials.size() == 1) return 0;
  const auto find = [&](auto has) {
    return static_cast<std::size_t>(
        std::find_if(scene.materials.begin(), scene.materials.end(), has) -
        scene.materials.begin());
  };
  std::size_t slot = find([&](const SceneMaterial& m) { return m.source == source; });
  if (slot == scene.materials.size()) {
    slot = find([&](const SceneMaterial& m) { return m.name == default_slot; });
  }
  if (slot == scene.materials.size()) Fail("slot: the scene has no material '", default_slot, "'");
  return slot;
}

Row RunCase(const Options& options, const Case& one, const std::string& scene,
            const std::string& material, FitLog* log) {
  Row row = {scene, material, one.share(), {}};
  for (const Method& method : kMethods) {
    std::vector<double> rmse, flip;
    for (int seed : options.seeds) {
      const ImageError error = one.Run(method, static_cast<std::uint64_t>(seed));
      log->AddRow({scene, material, method.name, StrCat(options.samples / method.divisor),
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

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const std::vector<MaterialSource> materials =
      ParseMaterials(arguments, kDefaultMaterials, options.sgd);
  FitLog log(output.Path("scene_fit.csv"),
             {"scene", "material", "method", "samples", "seed", "rmse", "flip"});
  std::vector<Row> rows;
  for (const std::string& path : options.scenes) {
    const Scene scene = ReadSmallScene(path, options.environment, options.film_width);
    Proposals proposals;
    const std::string name = std::filesystem::path(path).stem();
    for (const MaterialSource& material : materials) {
      const std::size_t slot = SlotOf(scene, material.source, options.slot);
      rows.push_back(RunCase(options, Case(options, scene, proposals, slot, material.source), name,
                             material.name, &log));
    }
  }
  output.WriteReport(
      "scene_fit",
      StrCat(options.samples, " training samples, or a third; seeds ", Joined(options.seeds, ","),
             "; images ", options.film_width, " pixels wide, ", options.samples_per_pixel,
             " samples a pixel.\n\n", Markdown(rows)));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
