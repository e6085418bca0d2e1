// render.h: images of scenes, by path tracing.
//
// Paths start at the camera and go where the materials reflect (brdf/importance_sampler.h); at each
// reflection one light, chosen uniformly, is sampled too. What both find is combined by multiple
// importance sampling with the power heuristic [1]. All paths of a tile take their next step
// together, and reflectances are asked for by material, hundreds at once, as networks need it.
// After a few reflections paths go on with the probability of what they still carry (Russian
// roulette).
//
// What the image doesn't depend on is left out, and counted (work.h): materials that no path gets
// to, rays through tiles without shapes, and reflectances for directions below the horizon, for
// lights that are hidden, and for paths that come to nothing: a path is followed to its next place
// before the material is asked how much arrives from there.
//
// [1] E. Veach. Robust Monte Carlo Methods for Light Transport Simulation. Thesis, 1997, section
// 9.2.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/image/image.h"
#include "pbnbrdf/render/scene.h"
#include "pbnbrdf/render/work.h"

namespace pbnbrdf {

struct OpenedMaterial {
  std::unique_ptr<Brdf> brdf;  // not null
  // How directions are chosen; fitted to the Brdf if absent. Materials with the same one send all
  // paths the same way, until Russian roulette ends some, so that their images can be compared.
  std::optional<LobeProposal> proposal = {};
};

// The material that a SceneMaterial's source names; throws Error. Called when the first path gets
// there, from any thread, but by one at a time.
using MaterialOpener = std::function<OpenedMaterial(const std::string& source)>;

// Where the light at a reflection is looked for; the means of the images are the same. Point and
// directional lights are always sampled, as no other way finds them.
enum class Estimator { kMis, kBrdf, kLight };

inline constexpr NameTable<Estimator, 3> kEstimators = {
    {{"mis", Estimator::kMis}, {"brdf", Estimator::kBrdf}, {"light", Estimator::kLight}}};

struct RenderProgress {
  double fraction;  // of the samples, those that target_error saves counted as done
  double seconds;
};

struct RenderOptions {
  int samples_per_pixel = 256;  // >= 1, uniform in the pixel
  std::uint64_t seed = 1;
  int threads = 0;       // 0: one for each core; the image is the same
  int max_bounces = 64;  // reflections between the camera and a light, 0 to 100,000; 0: lights only
  Estimator estimator = Estimator::kMis;
  // Pixels get no more samples once they are known this well: a block of 4 x 4 pixels (fewer at the
  // right and the bottom of the image) is finished when each of them has at least 32 samples, and
  // the standard error of its mean luminance, as its samples estimate it, is below
  // target_error (mean luminance + 0.01). This is looked at every 16 samples. Finite and >= 0; 0:
  // never. Stopping by what was found makes pixels slightly too dark: below the error itself.
  double target_error = 0.0;
  // Leave out what the image doesn't depend on; false: do it and throw it away, for comparison.
  // Both give the same bits. Doesn't concern target_error.
  bool skip = true;
  // Called after each tile, by one thread at a time; false: stop, and keep the image so far.
  std::function<bool(const RenderProgress&)> on_progress = {};
};

struct RenderSummary {
  bool stopped = false;
  std::int64_t samples = 0;          // paths in the image
  std::int64_t dropped_samples = 0;  // of radiance that isn't finite; not in the image
  RenderWork work;
  double seconds = 0.0;  // of Render, opening the materials included
};

struct Rendering {
  Image image;  // mean radiance of each pixel's samples; black where there are none
  std::vector<std::int64_t> samples;  // of each pixel, in its mean; row by row
  RenderSummary summary;
};

// Throws Error "RenderOptions::threads = -1; must be >= 0".
void ValidateRender(const RenderOptions& options);

// Opens the materials that paths get to, when they do (without `skip` all, first of all), and
// renders. Throws Error if an option is out of its range or a material can't be opened
// ("materials.gold: ..."): at the end of the pass over the image in which a path got there, the
// first of the scene's materials that failed, so that it is always the same one. A material that
// only rare paths get to may fail late. The same arguments give the same bits.
Rendering Render(const Scene& scene, const MaterialOpener& open, const RenderOptions& options = {});

}  // namespace pbnbrdf
