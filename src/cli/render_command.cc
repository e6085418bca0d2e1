// pbnbrdf render
#include <gflags/gflags.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "commands.h"
#include "interrupt.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/render/render.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "render_summary.h"
#include "shared_flags.h"

DECLARE_uint64(seed);
DECLARE_int32(threads);
DECLARE_bool(quiet);
DECLARE_string(summary);
DEFINE_string(scene, "", "scene file (JSON); problems/scenes/README.md describes it");
DEFINE_string(environment, "",
              "OpenEXR file, latitude-longitude, in place of the scene's environment light");
DEFINE_string(fits, "", "folder of networks that fit --scene has fitted to the scene's materials");
DEFINE_string(png, "", "write the image as PNG (sRGB), too");
DEFINE_double(exposure, 1.0, "of the PNG: what radiance is multiplied by, > 0");
DEFINE_int32(samples_per_pixel, 256, "paths for each pixel");
DEFINE_int32(max_bounces, 64, "reflections between camera and light, at most");
DEFINE_string(estimator, "mis",
              "where the light at a reflection is looked for: brdf (where the material reflects), "
              "light, or mis (both); the images differ in noise only");
DEFINE_double(
    target_error, 0.0,
    "stop sampling pixels whose standard error is below this times (mean + 0.01); 0: never");
DEFINE_bool(no_skip, false,
            "do all that the image doesn't depend on, too, to compare with: the same image");

namespace pbnbrdf::cli {
namespace {

// --material=NAME=SOURCE, several with ; in between.
std::map<std::string, std::string> MaterialChanges() {
  std::map<std::string, std::string> sources;
  if (FLAGS_material.empty()) return sources;
  for (const std::string& change : Split(FLAGS_material, ';')) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == change.size()) {
      throw UsageError(StrCat("--material=", change, "; of the form NAME=SOURCE"));
    }
    if (!sources.emplace(change.substr(0, equals), change.substr(equals + 1)).second) {
      throw UsageError(StrCat("--material: ", change.substr(0, equals), " is there twice"));
    }
  }
  return sources;
}

// The networks that fit --scene has left in the folder take the place of their materials.
void TakeFits(const std::string& folder, std::vector<SceneMaterial>* materials) {
  bool found = false;
  for (SceneMaterial& material : *materials) {
    const std::filesystem::path file =
        std::filesystem::path(folder) / (material.name + ".safetensors");
    if (!std::filesystem::exists(file)) continue;
    found = true;
    material.source = file;
    material.scale_to_albedo = 0.0;  // the network is of the scaled material
  }
  if (!found) Fail("--fits=", folder, ": has none of the scene's materials, NAME.safetensors");
}

RenderOptions ParseOptions() try {
  RenderOptions options;
  options.samples_per_pixel = FLAGS_samples_per_pixel;
  options.seed = FLAGS_seed;
  options.threads = FLAGS_threads;
  options.max_bounces = FLAGS_max_bounces;
  options.estimator = ParseName(kEstimators, "--estimator", FLAGS_estimator);
  options.target_error = FLAGS_target_error;
  options.skip = !FLAGS_no_skip;
  ValidateRender(options);
  if (!(FLAGS_exposure > 0.0) || !std::isfinite(FLAGS_exposure)) {
    Fail("--exposure = ", FLAGS_exposure, "; must be finite and > 0");
  }
  return options;
} catch (const Error& error) {
  std::string message = error.what();
  const std::string_view field = "RenderOptions::";  // its fields are called as the flags are
  if (message.starts_with(field)) message.replace(0, field.size(), "--");
  throw UsageError(message);
}

std::map<std::string, std::string> Metadata(const RenderSummary& summary) {
  std::map<std::string, std::string> metadata = {{"pbnbrdf:version", PBNBRDF_VERSION},
                                                 {"pbnbrdf:scene", FLAGS_scene},
                                                 {"pbnbrdf:seed", StrCat(FLAGS_seed)},
                                                 {"pbnbrdf:samples", StrCat(summary.samples)}};
  metadata["pbnbrdf:stopped"] = summary.stopped ? "true" : "false";
  for (const std::string& line : FlagLines({"environment", "material", "fits", "samples_per_pixel",
                                            "max_bounces", "estimator", "target_error"})) {
    const std::size_t equals = line.find('=');
    metadata["pbnbrdf:" + line.substr(2, equals - 2)] = line.substr(equals + 1);
  }
  return metadata;
}

void WriteImages(const Rendering& rendering) {
  std::vector<FileContent> files = {
      {FLAGS_out, ExrBytes(rendering.image, Metadata(rendering.summary))}};
  if (!FLAGS_png.empty()) files.push_back({FLAGS_png, PngBytes(rendering.image, FLAGS_exposure)});
  if (!FLAGS_summary.empty()) {
    files.push_back({FLAGS_summary, ToJson(rendering.summary).dump(2) + "\n"});
  }
  WriteFiles(files);
}

// --out and the flags of the files that are written beside it.
void CheckOutputs() {
  CheckWritable(FLAGS_out);
  std::vector<std::string> names = {FLAGS_out};
  for (const auto& [flag, name] :
       {std::pair("png", FLAGS_png), std::pair("summary", FLAGS_summary)}) {
    if (name.empty()) continue;
    CheckWritable(name);
    if (FLAGS_out == "-") throw UsageError(StrCat("--", flag, ": --out must be a file, too"));
    if (std::count(names.begin(), names.end(), name) > 0) {
      throw UsageError(StrCat(name, ": is to be two outputs at once"));
    }
    names.push_back(name);
  }
}

void PrintSummary(const Image& image, const RenderSummary& summary) {
  std::cout << FLAGS_out << ": " << image.width << " x " << image.height << " pixels, "
            << summary.samples << " samples, " << summary.seconds << " s"
            << (summary.stopped ? "; stopped early" : "") << "\n"
            << WorkText(summary.work);
}

int RunRender(const std::vector<std::string>&) {
  RequireFlag("scene", FLAGS_scene);
  RequireFlag("out", FLAGS_out);
  RenderOptions options = ParseOptions();
  const SceneChanges changes = {FLAGS_environment, MaterialChanges()};
  CheckOutputs();
  Scene scene = ReadScene(FLAGS_scene, changes);
  if (!FLAGS_fits.empty()) TakeFits(FLAGS_fits, &scene.materials);
  CatchInterrupt();
  const bool show_progress = !FLAGS_quiet && isatty(STDERR_FILENO);
  int shown = -1;
  options.on_progress = [&](const RenderProgress& progress) {
    const int percent = static_cast<int>(100.0 * progress.fraction);
    if (show_progress && percent != shown) {
      shown = percent;
      std::fprintf(stderr, "\r\033[K%d %%  %.1f s", percent, progress.seconds);
    }
    return !Interrupted();
  };
  const Rendering rendering = [&] {
    try {
      return Render(
          scene, [](const std::string& source) { return OpenedMaterial{OpenBrdf(source)}; },
          options);
    } catch (const Error& error) {
      Fail(FLAGS_scene, ": ", error.what());
    }
  }();
  if (show_progress) std::fprintf(stderr, "\r\033[K");
  WriteImages(rendering);
  const RenderSummary& summary = rendering.summary;
  if (!FLAGS_quiet && FLAGS_out != "-") PrintSummary(rendering.image, summary);
  if (summary.dropped_samples > 0) {
    std::cerr << "pbnbrdf: " << summary.dropped_samples
              << " samples dropped: their radiance wasn't finite\n";
  }
  return 0;
}

}  // namespace

Command RenderCommand() {
  Command command;
  command.name = "render";
  command.summary = "renders a scene with any materials, fitted networks too";
  command.usage =
      "  pbnbrdf render --scene=problems/scenes/sphere.json --out=sphere.exr --png=sphere.png\n"
      "  pbnbrdf render --scene=problems/scenes/sphere.json --environment=studio.exr \\\n"
      "                 --material=surface=gold.safetensors --out=gold.exr\n"
      "  pbnbrdf fit --scene=problems/scenes/one_of_many.json --out_dir=fits\n"
      "  pbnbrdf render --scene=problems/scenes/one_of_many.json --fits=fits --out=many.exr\n"
      "  pbnbrdf render --scene=problems/scenes/gallery.json --samples_per_pixel=4096 \\\n"
      "                 --target_error=0.02 --out=gallery.exr --summary=gallery.json\n";
  command.notes =
      "--material=NAME=SOURCE gives the scene's material NAME another source, several with ; in\n"
      "between. Files that a scene names are in its folder; sources of materials may be, too.\n"
      "--fits=DIR takes DIR/NAME.safetensors for material NAME, where there is one.\n"
      "\nWhat the image doesn't depend on is left out: materials that no path gets to aren't "
      "opened,\n"
      "parts of the image without shapes trace no rays, and materials aren't asked for directions\n"
      "below the horizon, hidden lights, or paths that lead to no light. The lines printed in the "
      "end\n"
      "and --summary=FILE.json (the same as numbers) count what was done, what was skipped and "
      "why, "
      "and\n"
      "estimate the time saved: skipped ones times the mean time of one that was done. --no_skip "
      "does\n"
      "it all: the same bits, later, and an error if any material can't be opened.\n"
      "\n--target_error=E gives pixels no more samples once each of a block of 4 x 4 has at least "
      "32 and\n"
      "a standard error of the mean luminance below E (mean + 0.01), looked at every 16 samples;\n"
      "--samples_per_pixel is the most that a pixel gets.\n"
      "\nThe OpenEXR file holds linear radiance, RGB as float, and says in its header how it was "
      "made.\n"
      "The image depends on the seed, not on the number of threads. Ctrl-C stops after the tile "
      "and\n"
      "keeps the image so far.\n\n" +
      std::string(kSourceNotes);
  command.flags = {{"",
                    {"scene", "environment", "material", "fits", "out", "png", "exposure",
                     "summary", "samples_per_pixel", "target_error", "seed", "max_bounces",
                     "estimator", "no_skip", "threads", "quiet"}}};
  command.run = RunRender;
  return command;
}

}  // namespace pbnbrdf::cli
