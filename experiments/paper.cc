// paper.cc: the paper's tables and figures, regenerated: published networks, NBRDF's recipe, each of the paper's
// steps, and ours.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "base/text.h"
#include "discontinuity.h"
#include "experiment.h"
#include "materials.h"
#include "measure/shown_lpips.h"
#include "option_fields.h"
#include "paper_tables.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "picture_grid.h"
#include "problems.h"
#include "process.h"
#include "render/studio.h"
#include "small_scene.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(paper: the paper's Tables 1 to 3 and Figures 1 to 3, regenerated.

  paper --out_dir=results --database=merl_and_rgl --networks=nbrdf --sgd=parameters.csv
  paper --out_dir=results builtin:satin-gold rgl/chm_mint_rgb.bsdf

The arguments are materials; without any, all MERL and RGL files in the folder --database and below it,
built-in materials, and, with --sgd, 13 of the SGD model. The methods: the published network (NAME.h5 in
a folder of --networks; others that are there stand in Table 1), NBRDF's recipe and then each of the
paper's three steps, fitted by Adam (reciprocal inputs, the energy term, the chromaticity term), and
ours, the default of pbnbrdf fit. Fits are made by pbnbrdf fit --out_dir: those that are there are kept,
and a run that was ended goes on. paper.csv has all numbers.
)" + std::string(kMaterialsHelp);

struct Step {
  const char *folder, *method;
  std::vector<std::string> flags;
};

std::vector<Step> Steps() {
  const auto file = [](const char* name) { return "--flagfile=" + ShippedProblemFile(name); };
  return {{"nbrdf", kRecipe, {file("nbrdf_adam")}},
          {"reciprocity", "+ reciprocity", {file("nbrdf_adam"), "--encoding=reciprocal"}},
          {"energy", "+ energy", {file("pbnbrdf_adam"), "--terms=log,energy:1"}},
          {"chromaticity", "+ chromaticity", {file("pbnbrdf_adam")}},
          {"ours", kOurs, {}}};
}

constexpr const char* kBuiltins[] = {"spectralon",   "wall-plaster",      "white-ceramic-tile",
                                     "satin-gold",   "polished-chromium", "silver-mirror",
                                     "rolled-brass", "red-satin-plastic"};
constexpr const char* kSgd[] = {"white-diffuse-bball",
                                "teflon",
                                "pink-felt",
                                "beige-fabric",
                                "nylon",
                                "yellow-matte-plastic",
                                "gold-metallic-paint",
                                "alum-bronze",
                                "specular-black-phenolic",
                                "black-obsidian",
                                "tungsten-carbide",
                                "chrome-steel",
                                "white-marble"};
constexpr double kLowDissipation = 0.8;  // least largest albedo of Table 2's materials
constexpr double kLastMaterialAngle = 85.0 * std::numbers::pi / 180.0;  // nothing is known beyond
constexpr std::size_t kHeldOut = 50000;
constexpr std::uint64_t kMeasureSeed = 1;
constexpr double kMaxFlip = 0.2;  // white in the pictures of FLIP
constexpr std::size_t kRowsOfFigure = 3;

struct Options {
  std::string database, sgd, scene = "problems/scenes/sphere.json",
                             cove = "problems/scenes/cove.json", environment, lpips;
  std::vector<std::string> networks;
  int film_width = 256, samples_per_pixel = 64, threads = 0, jobs = 0;
  std::optional<int> max_iterations;
  std::optional<std::uint64_t> samples;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Text("database", &o->database, "folder of MERL (.binary) and RGL (.bsdf) files"));
  fields.Add(Texts("networks", &o->networks, "folders of published networks, NAME.h5"));
  fields.Add(Text("scene", &o->scene, "scene file, of one material, for the pictures"));
  fields.Add(Text("cove", &o->cove, "concave scene file, of one material, for figure 3"));
  fields.Add(Text("environment", &o->environment,
                  "OpenEXR file that takes the place of the scene's environment light"));
  fields.Add(
      Text("lpips", &o->lpips, "weights of LPIPS ('pbnbrdf compare --help'): a column of Table 3"));
  fields.Add(Integer("film_width", &o->film_width, AtLeast(16), "pixels of each picture"));
  fields.Add(Integer("samples_per_pixel", &o->samples_per_pixel, AtLeast(1), "of each picture"));
  fields.Add(OverridingInteger("max_iterations", &o->max_iterations, AtLeast(0),
                               "iterations, or epochs, of each fit, at most"));
  fields.Add(OverridingInteger("samples", &o->samples, AtLeast(1), "training samples of each fit"));
  fields.Add(Integer("jobs", &o->jobs, AtLeast(0), "fits at a time; 0: one for each core"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "of the pictures; 0: one for each core"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

std::vector<std::string> DefaultMaterials(const Options& options) {
  std::vector<std::string> all;
  if (!options.database.empty()) {
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(options.database)) {
      const std::string ending = LowerCase(entry.path().extension().string());
      if (ending == ".binary" || ending == ".bsdf") files.insert(entry.path());
    }
    all.assign(files.begin(), files.end());
  }
  if (!options.sgd.empty()) {
    for (const char* name : kSgd) all.push_back(StrCat("sgd:", name));
  }
  for (const char* name : kBuiltins) all.push_back(StrCat("builtin:", name));
  return all;
}

// The folder of the networks of a step.
std::string FolderOf(const Step& step, const Output& output) {
  return output.Path(StrCat("fits/", step.folder));
}

// Runs pbnbrdf fit for all materials. Those that fail are missing afterwards; it says which.
void FitAll(const std::vector<MaterialSource>& materials, const Options& options,
            const Output& output) {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::vector<std::string> sources;
  for (const MaterialSource& material : materials) sources.push_back(material.source);
  for (const Step& step : Steps()) {
    std::fprintf(stderr, "%s: %zu fits\n", step.method, materials.size());
    std::vector<std::string> command = {here / "pbnbrdf",
                                        "fit",
                                        "--material=" + Join(sources, ";"),
                                        "--out_dir=" + FolderOf(step, output),
                                        StrCat("--jobs=", options.jobs),
                                        "--quiet"};
    command.insert(command.end(), step.flags.begin(), step.flags.end());
    if (options.max_iterations)
      command.push_back(StrCat("--max_iterations=", *options.max_iterations));
    if (options.samples) command.push_back(StrCat("--samples=", *options.samples));
    if (RunProgram(command).status > 1) Fail("pbnbrdf fit ended early: ", step.method);
  }
}

// What stands for a material: by a method's name, where its network is.
struct Candidate {
  std::string method, file;
};

std::vector<Candidate> CandidatesOf(const MaterialSource& material, const Options& options,
                                    const Output& output) {
  std::vector<Candidate> all;
  const auto add = [&](const std::string& method, const std::string& file) {
    if (std::filesystem::exists(file)) all.push_back({method, file});
  };
  for (const std::string& folder : options.networks) {
    if (IsMeasurement(material)) add(kPublishedNetwork, folder + "/" + material.name + ".h5");
  }
  for (const Step& step : Steps()) {
    add(step.method, FolderOf(step, output) + "/" + material.name + ".safetensors");
  }
  return all;
}

class Study {
 public:
  Study(const Options& options, const Output& output)
      : options_(options),
        output_(output),
        sphere_(OneMaterialScene(options.scene, options.environment)),
        cove_(OneMaterialScene(options.cove, "")) {
    if (!options.lpips.empty()) lpips_.emplace(options.lpips);
  }

  void Add(const MaterialSource& source) {
    const std::unique_ptr<Brdf> material = OpenBrdf(source.source);
    const auto heldout = HeldOutSamples(*material, kHeldOut, kMeasureSeed);
    PaperRecord itself = WithoutPicture(source.name, kItself);
    itself.reciprocity = MeasureReciprocity(*material);
    itself.energy = MeasureEnergy(*material, {.last_angle = kLastMaterialAngle});
    const double albedo = itself.energy.max_directional_albedo;
    itself.low_dissipation = albedo >= kLowDissipation && albedo <= 1.0;
    records_.push_back(itself);
    const Studio studio(sphere_, *material, options_.samples_per_pixel, options_.threads);
    const Image reference = studio.Photograph([&] { return OpenBrdf(source.source); });
    for (const Candidate& candidate : CandidatesOf(source, options_, output_)) {
      const std::unique_ptr<Brdf> fit = OpenBrdf(candidate.file);
      PaperRecord record = itself;
      record.method = candidate.method;
      record.log_error = MeasureErrors(heldout, *fit).mean_abs_log_error;
      record.reciprocity = MeasureReciprocity(*fit);
      record.energy = MeasureEnergy(*fit);
      const Image picture = studio.Photograph([&] { return OpenBrdf(candidate.file); });
      record.picture = CompareImages(reference, picture);
      if (lpips_) record.lpips = lpips_->Of(reference, picture, record.picture.exposure);
      records_.push_back(record);
    }
    sources_[source.name] = source;
    std::fprintf(stderr, "%s measured\n", source.name.c_str());
  }

  // Published networks of materials that aren't among those that were added: what can be said of them alone.
  void AddOtherNetworks() {
    for (const std::string& folder : options_.networks) {
      for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().stem();
        const auto known = sources_.find(name);
        if (entry.path().extension() != ".h5" ||
            (known != sources_.end() && IsMeasurement(known->second))) {
          continue;
        }
        const std::unique_ptr<Brdf> network = OpenBrdf(entry.path());
        PaperRecord record =
            WithoutPicture(name + " (network)", "published network, without its material");
        record.reciprocity = MeasureReciprocity(*network);
        record.energy = MeasureEnergy(*network);
        records_.push_back(record);
      }
    }
  }

  void Write() const {
    std::string text = PaperMarkdown(records_) + "### Figures\n\n";
    text += Figure1() + Figure2() + Figure3();
    WriteFile(output_.Path("paper.csv"), PaperCsv(records_));
    output_.WriteReport("paper", text);
  }

 private:
  static PaperRecord WithoutPicture(const std::string& material, const std::string& method) {
    PaperRecord record;
    record.material = material;
    record.method = method;
    record.log_error = record.picture.mae = record.picture.mse = record.picture.psnr =
        record.picture.ssim = record.picture.flip = std::numeric_limits<double>::quiet_NaN();
    return record;
  }

  Scene OneMaterialScene(const std::string& path, const std::string& environment) const {
    Scene scene = ReadSmallScene(path, environment, options_.film_width);
    if (scene.materials.size() != 1) Fail(path, ": must have one material");
    return scene;
  }

  // The file of a method's network, "" if there is none.
  std::string FileOf(const std::string& material, const std::string& method) const {
    const auto source = sources_.find(material);
    if (source == sources_.end()) return "";
    for (const Candidate& candidate : CandidatesOf(source->second, options_, output_)) {
      if (candidate.method == method) return candidate.file;
    }
    return "";
  }

  // What pictures set ours against: the published network, or else that of the published recipe.
  Candidate BaselineOf(const std::string& material) const {
    for (const char* method : {kPublishedNetwork, kRecipe}) {
      if (const std::string file = FileOf(material, method); !file.empty()) return {method, file};
    }
    return {};
  }

  // What pictures show beside the material.
  std::vector<Candidate> RivalsOf(const std::string& material) const {
    return {BaselineOf(material), {kOurs, FileOf(material, kOurs)}};
  }

  static std::string Said(const std::string& figure, const std::string& why) {
    return StrCat("- `", figure, "`", why.empty() ? "" : StrCat(" (", why, ")"), ": ");
  }

  // The network, the material and the light where a network that isn't reciprocal is seen to be so.
  std::string Figure1() const {
    Discontinuity worst;
    Candidate network;
    std::string material;
    for (const auto& [name, source] : sources_) {
      for (const char* method : {kPublishedNetwork, kRecipe}) {
        const std::string file = FileOf(name, method);
        if (file.empty() || FileOf(name, kOurs).empty()) continue;
        const Discontinuity found = WorstDiscontinuity(*OpenBrdf(file));
        if (found.jump <= worst.jump) continue;
        worst = found;
        network = {method, file};
        material = name;
      }
    }
    if (material.empty()) return "";
    const std::string source = sources_.at(material).source;
    PictureGrid grid(3);
    for (const bool close : {false, true}) {
      const Scene scene = SphereUnderOneLight(worst.theta_d, close);
      const Studio studio(scene, *OpenBrdf(source), options_.samples_per_pixel, options_.threads);
      grid.Add(material, studio.Photograph([&] { return OpenBrdf(source); }));
      for (const Candidate& fit : {network, Candidate{kOurs, FileOf(material, kOurs)}}) {
        grid.Add(fit.method, studio.Photograph(
                                 [&] { return std::make_unique<FoldedBrdf>(OpenBrdf(fit.file)); }));
      }
    }
    return StrCat(
        Said("paper_figure1.png", grid.Write(output_.Path("paper_figure1.png"))),
        "the tangential discontinuity where it is worst of all networks here, ", network.method,
        " of ", material, " under a light at ",
        std::lround(2.0 * worst.theta_d * 180.0 / std::numbers::pi),
        " degrees from the viewer, and close-ups: along the line through the highlight values jump "
        "by ",
        Significant(worst.jump, 3),
        " of white in the mean. phi_d is folded to half a turn, as MERL's tables have it.\n");
  }

  // The highlight is theta_d from the middle, towards +x.
  Scene SphereUnderOneLight(double theta_d, bool close) const {
    const double x = close ? 0.5 * std::sin(theta_d) : 0.0, angle = 2.0 * theta_d;
    const std::string text =
        StrCat(R"({"camera": {"origin": [0, 0, 8], "up": [0, 1, 0], "target": [)", x,
               R"(, 0, 0], "field_of_view": )", close ? 2.2 : 8.0, R"(}, "film": {"width": )",
               options_.film_width, R"(, "height": )", options_.film_width,
               R"(}, "materials": {"surface": {"source": "builtin:spectralon"}},
            "shapes": [{"type": "sphere", "radius": 0.5, "material": "surface"}],
            "lights": [{"type": "directional", "direction": [)",
               -std::sin(angle), ", 0, ", -std::cos(angle),
               R"(], "irradiance": [3.14159, 3.14159, 3.14159]}]})");
    return ParseScene(text, "");
  }

  // Of the materials that both have, those with the least, the median and the largest PSNR of the baseline.
  std::string Figure2() const {
    std::vector<std::pair<double, std::string>> ranked;
    for (const PaperRecord& record : records_) {
      if (record.method == BaselineOf(record.material).method &&
          !FileOf(record.material, kOurs).empty()) {
        ranked.push_back({record.picture.psnr, record.material});
      }
    }
    if (ranked.empty()) return "";
    std::sort(ranked.begin(), ranked.end());
    std::set<std::size_t> places = {0, ranked.size() / 2, ranked.size() - 1};
    PictureGrid grid(5);
    for (const std::size_t place : places) AddRow(ranked[place].second, &grid);
    return StrCat(
        Said("paper_figure2.png", grid.Write(output_.Path("paper_figure2.png"))),
        "the materials of the baseline's least, median and largest PSNR; FLIP from 0 (black) to ",
        kMaxFlip, " (white).\n");
  }

  void AddRow(const std::string& material, PictureGrid* grid) const {
    const std::string source = sources_.at(material).source;
    const Studio studio(sphere_, *OpenBrdf(source), options_.samples_per_pixel, options_.threads);
    const Image reference = studio.Photograph([&] { return OpenBrdf(source); });
    const double exposure = DisplayExposure(reference);
    const Image shown = Exposed(reference, exposure);
    grid->Add(material, shown);
    std::vector<std::pair<std::string, Image>> maps;
    for (const Candidate& fit : RivalsOf(material)) {
      const Image image = studio.Photograph([&] { return OpenBrdf(fit.file); });
      grid->Add(
          StrCat(fit.method, ", ", Significant(CompareImages(reference, image).psnr, 3), " dB"),
          Exposed(image, exposure));
      maps.push_back(
          {"FLIP of " + fit.method, FlipPicture(shown, Exposed(image, exposure), kMaxFlip)});
    }
    for (const auto& [label, map] : maps) grid->Add(label, map);
  }

  // In a concave scene, of materials that reflect nearly all light, those whose baseline makes most energy.
  std::string Figure3() const {
    std::vector<std::pair<double, std::string>> ranked;
    for (const PaperRecord& record : records_) {
      if (record.low_dissipation && record.method == BaselineOf(record.material).method &&
          !FileOf(record.material, kOurs).empty()) {
        ranked.push_back({-record.energy.max_directional_albedo, record.material});
      }
    }
    if (ranked.empty()) return "";
    std::sort(ranked.begin(), ranked.end());
    ranked.resize(std::min(ranked.size(), kRowsOfFigure));
    PictureGrid grid(3);
    for (const auto& [albedo, material] : ranked) {
      const std::string source = sources_.at(material).source;
      const Studio studio(cove_, *OpenBrdf(source), options_.samples_per_pixel, options_.threads);
      const Image reference = studio.Photograph([&] { return OpenBrdf(source); });
      const double exposure = DisplayExposure(reference);
      grid.Add(material, Exposed(reference, exposure));
      for (const Candidate& fit : RivalsOf(material)) {
        const Image image = studio.Photograph([&] { return OpenBrdf(fit.file); });
        const double largest = MeasureEnergy(*OpenBrdf(fit.file)).max_directional_albedo;
        grid.Add(StrCat(fit.method, ", albedo ", Significant(largest, 4), ", ",
                        Significant(CompareImages(reference, image).psnr, 3), " dB"),
                 Exposed(image, exposure));
      }
    }
    return StrCat(Said("paper_figure3.png", grid.Write(output_.Path("paper_figure3.png"))),
                  "a concave scene of materials that reflect nearly all light, those first whose "
                  "baseline makes most "
                  "energy.\n");
  }

  const Options& options_;
  const Output& output_;
  const Scene sphere_, cove_;
  std::optional<ShownLpips> lpips_;
  std::vector<PaperRecord> records_;
  std::map<std::string, MaterialSource> sources_;  // by name
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const std::vector<MaterialSource> materials =
      ParseMaterials(arguments, DefaultMaterials(options), options.sgd);
  Study study(options, output);
  FitAll(materials, options, output);
  for (const MaterialSource& material : materials) study.Add(material);
  study.AddOtherNetworks();
  study.Write();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
