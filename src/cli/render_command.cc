// pbnbrdf render
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/render/render.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "progress.h"
#include "render_summary.h"

namespace pbnbrdf::cli {
namespace {

struct RenderCommandOptions {
  std::string scene, environment, materials, fits, out, png, summary;
  double exposure = 1.0;
  bool symmetrize = false, no_skip = false, quiet = false;
  RenderOptions render;
};

// What the image's file records, besides the scene and the seed. ValidateRender knows the ranges.
Fields RecordedFields(RenderCommandOptions* options) {
  RenderOptions* render = &options->render;
  Fields fields;
  fields.AddCommon(Text("environment", &options->environment,
                        "OpenEXR file (latitude-longitude) that replaces the scene's environment "
                        "light"));
  fields.AddCommon(Text("material", &options->materials,
                        "NAME=SOURCE;...: sources that replace those of the scene's materials"));
  fields.AddCommon(Text("fits", &options->fits,
                        "folder of networks that fit-scene wrote; they replace the materials"));
  fields.AddCommon(SymmetrizeField(&options->symmetrize));
  fields.AddCommon(
      Integer("samples_per_pixel", &render->samples_per_pixel, Any(), "paths for each pixel"));
  fields.Add(Integer("max_bounces", &render->max_bounces, Any(),
                     "maximum number of reflections of a path"));
  fields.Add(Choice("estimator", &render->estimator, kEstimators,
                    "how light is found: by sampling the brdf, by sampling lights (light), or both "
                    "(mis); the images differ in noise only"));
  fields.AddCommon(Number("target_error", &render->target_error, Any(),
                          "stop sampling pixels whose standard error is below this times "
                          "(mean + 0.01); 0: off"));
  return fields;
}

Fields RenderFields(RenderCommandOptions* options) {
  Fields fields;
  fields.AddRequired(
      Text("scene", &options->scene, "scene file (JSON); problems/scenes/README.md describes it"));
  fields.AddRequired(Text("out", &options->out, "OpenEXR file for the image"));
  fields.AddCommon(Text("png", &options->png, "also write the image as PNG (sRGB)"));
  fields.AddCommon(
      Number("exposure", &options->exposure, Above(0.0), "factor on the radiance in the PNG"));
  fields.AddCommon(
      Text("summary", &options->summary, "JSON file for counts of what was done and skipped"));
  fields.Add(RecordedFields(options));
  fields.AddCommon(Integer("seed", &options->render.seed, Any(), "seed of the paths"));
  fields.Add(Switch("no_skip", &options->no_skip,
                    "also do the work that cannot change the image; for comparison: the image "
                    "stays the same, bit for bit"));
  fields.Add(
      Integer("threads", &options->render.threads, Any(), "threads to use; 0: one for each core"));
  fields.AddCommon(Switch("quiet", &options->quiet, "print nothing"));
  return fields;
}

// Reads --material=NAME=SOURCE;NAME=SOURCE;...
std::map<std::string, std::string> MaterialChanges(const std::string& changes) {
  std::map<std::string, std::string> sources;
  if (changes.empty()) return sources;
  for (const std::string& change : Split(changes, ';')) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == change.size()) {
      throw UsageError(StrCat("--material=", change, ": must be of the form NAME=SOURCE"));
    }
    if (!sources.emplace(change.substr(0, equals), change.substr(equals + 1)).second) {
      throw UsageError(StrCat("--material: ", change.substr(0, equals), " is given twice"));
    }
  }
  return sources;
}

// Replaces each material by its network in the folder, where fit-scene has written one.
void UseFits(const std::string& folder, std::vector<SceneMaterial>* materials) {
  bool found = false;
  for (SceneMaterial& material : *materials) {
    const std::filesystem::path file =
        std::filesystem::path(folder) / (material.name + ".safetensors");
    if (!std::filesystem::exists(file)) continue;
    found = true;
    material.source = file;
    material.scale_to_albedo = 0.0;  // the network was fitted to the scaled material
  }
  if (!found)
    Fail("--fits=", folder, ": has no NAME.safetensors for any material NAME of the scene");
}

RenderOptions CheckedOptions(const RenderCommandOptions& options) try {
  RenderOptions render = options.render;
  render.skip = !options.no_skip;
  ValidateRender(render);
  return render;
} catch (const Error& error) {
  std::string message = error.what();
  const std::string_view field = "RenderOptions::";  // its fields have the names of the flags
  if (message.starts_with(field)) message.replace(0, field.size(), "--");
  throw UsageError(message);
}

std::map<std::string, std::string> Metadata(RenderCommandOptions options,
                                            const RenderSummary& summary) {
  std::map<std::string, std::string> metadata = {
      {"pbnbrdf:version", PBNBRDF_VERSION},
      {"pbnbrdf:scene", options.scene},
      {"pbnbrdf:seed", StrCat(options.render.seed)},
      {"pbnbrdf:samples", StrCat(summary.samples)},
      {"pbnbrdf:stopped", summary.stopped ? "true" : "false"}};
  const Fields recorded = RecordedFields(&options);
  for (const Field& field : recorded.all()) metadata["pbnbrdf:" + field.name] = field.text();
  return metadata;
}

void WriteImages(const RenderCommandOptions& options, const Rendering& rendering) {
  std::vector<FileContent> files = {
      {options.out, ExrBytes(rendering.image, Metadata(options, rendering.summary))}};
  if (!options.png.empty()) {
    files.push_back({options.png, PngBytes(rendering.image, options.exposure)});
  }
  if (!options.summary.empty()) {
    files.push_back({options.summary, JsonText(ToJson(rendering.summary))});
  }
  WriteFiles(files);
}

Rendering RenderScene(const RenderCommandOptions& options, const Scene& scene,
                      RenderOptions render) try {
  const ProgressLine line(options.quiet);
  int shown = -1;
  render.on_progress = [&](const RenderProgress& progress) {
    const int percent = static_cast<int>(100.0 * progress.fraction);
    if (percent != shown) line.Show(StrCat(percent, " %  ", SecondsText(progress.seconds)));
    shown = percent;
    return !Interrupted();
  };
  const auto open = [&](const std::string& source) {
    return OpenedMaterial{MaterialOptions{source, 0.0, options.symmetrize}.Open()};
  };
  return Render(scene, open, render);
} catch (const Error& error) {
  Fail(options.scene, ": ", error.what());
}

void PrintSummary(const std::string& out, const Image& image, const RenderSummary& summary) {
  std::cout << out << ": " << image.width << " x " << image.height << " pixels, " << summary.samples
            << " samples, " << summary.seconds << " s" << (summary.stopped ? "; stopped early" : "")
            << "\n"
            << WorkText(summary.work);
}

int RunRender(const RenderCommandOptions& options, const Arguments&) {
  const RenderOptions render = CheckedOptions(options);
  const SceneChanges changes = {options.environment, MaterialChanges(options.materials)};
  const std::vector<Output> outputs = {
      {"out", options.out}, {"png", options.png}, {"summary", options.summary}};
  CheckOutputs(outputs);
  Scene scene = ReadSceneAndTell(options.scene, changes);
  if (!options.fits.empty()) UseFits(options.fits, &scene.materials);
  CatchInterrupt();
  const Rendering rendering = RenderScene(options, scene, render);
  WriteImages(options, rendering);
  const RenderSummary& summary = rendering.summary;
  if (!options.quiet && !UseStandardOutput(outputs)) {
    PrintSummary(options.out, rendering.image, summary);
  }
  if (summary.dropped_samples > 0) {
    std::cerr << "pbnbrdf: " << summary.dropped_samples
              << " samples were dropped: their radiance was not finite\n";
  }
  return 0;
}

}  // namespace

Command RenderCommand() {
  return Command{
      .name = "render",
      .summary = "renders a scene with any materials, fitted networks too",
      .usage =
          R"(  pbnbrdf render --scene=problems/scenes/sphere.json --out=sphere.exr --png=sphere.png
  pbnbrdf render --scene=problems/scenes/sphere.json --environment=studio.exr \
                 --material=surface=gold.safetensors --out=gold.exr
  pbnbrdf fit-scene --scene=problems/scenes/one_of_many.json --out_dir=fits
  pbnbrdf render --scene=problems/scenes/one_of_many.json --fits=fits --out=many.exr
  pbnbrdf render --scene=problems/scenes/gallery.json --samples_per_pixel=4096 \
                 --target_error=0.02 --out=gallery.exr --summary=gallery.json
)",
      .notes = StrCat(
          R"(--material=NAME=SOURCE replaces the source of the scene's material NAME; several are separated by
semicolons. --fits=DIR replaces each material NAME for which there is DIR/NAME.safetensors. Files
that a scene names are in its folder; sources of materials may also be elsewhere.

Work that cannot change the image is skipped: materials that no path hits are not opened, tiles that
show no shape trace no rays, and BRDFs are not evaluated for directions below the horizon, for
hidden lights, or for rays that lead to no light. The summary, printed at the end and written to
--summary=FILE.json, counts the work that was done and the work that was skipped, and why. The time
saved is estimated as the number skipped times the mean time of what was done. With --no_skip
nothing is skipped: the image is the same, bit for bit, but all materials must open.

--target_error=E samples adaptively: a block of 4 x 4 pixels stops when each pixel has at least 32
samples and a standard error of its mean luminance below E (mean + 0.01). That is checked every 16
samples. --samples_per_pixel is then the maximum for a pixel.

The OpenEXR file holds linear radiance, RGB as 32-bit floats, and its header says how it was made.
The image depends on the seed, but not on the number of threads. After Ctrl-C the current tiles are
finished and the image so far is written.

)",
          kSourceNotes)}
      .With(RenderFields, RunRender);
}

}  // namespace pbnbrdf::cli
