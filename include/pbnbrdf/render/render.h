// render.h: images of scenes, by path tracing.
//
// Paths start at the camera and go where the materials reflect (brdf/importance_sampler.h); at each
// reflection one light, chosen uniformly, is sampled too. What both find is combined by multiple
// importance sampling with the power heuristic [1]. All paths of a tile take their next step
// together, and reflectances are asked for by material, hundreds at once, as networks need it;
// light that is below the horizon or doesn't arrive is never asked for. After a few reflections
// paths go on with the probability of what they still carry (Russian roulette).
//
// [1] E. Veach. Robust Monte Carlo Methods for Light Transport Simulation. Thesis, 1997, section
// 9.2.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/image/image.h"
#include "pbnbrdf/render/scene.h"

namespace pbnbrdf {

// The material that a SceneMaterial's source names; throws Error.
using MaterialOpener = std::function<std::unique_ptr<Brdf>(const std::string& source)>;

// Where the light at a reflection is looked for; the means of the images are the same. Point and
// directional lights are always sampled, as no other way finds them.
enum class Estimator { kMis, kBrdf, kLight };

inline constexpr NameTable<Estimator, 3> kEstimators = {
    {{"mis", Estimator::kMis}, {"brdf", Estimator::kBrdf}, {"light", Estimator::kLight}}};

struct RenderProgress {
  double fraction;  // of the samples
  double seconds;
};

struct RenderOptions {
  int samples_per_pixel = 256;  // >= 1, uniform in the pixel
  std::uint64_t seed = 1;
  int threads = 0;       // 0: one for each core; the image is the same
  int max_bounces = 64;  // reflections between the camera and a light, 0 to 100,000; 0: lights only
  Estimator estimator = Estimator::kMis;
  // Called after each tile, by one thread at a time; false: stop, and keep the image so far.
  std::function<bool(const RenderProgress&)> on_progress = {};
};

struct RenderSummary {
  bool stopped = false;
  std::int64_t samples = 0;          // paths in the image
  std::int64_t dropped_samples = 0;  // of radiance that isn't finite; not in the image
  std::int64_t brdf_values = 0;      // that materials were asked for
  std::int64_t rays = 0;             // shadow rays, too
  int materials_opened = 0;          // those that a shape has
  double seconds = 0.0;
};

struct Rendering {
  Image image;  // mean radiance of each pixel's samples; black where there are none
  RenderSummary summary;
};

// Throws Error "RenderOptions::threads = -1; must be >= 0".
void ValidateRender(const RenderOptions& options);

// Opens the materials that shapes have, no others, and renders. Throws Error if an option is out of
// its range or a material can't be opened ("materials.gold: ..."). The same arguments give the same
// bits.
Rendering Render(const Scene& scene, const MaterialOpener& open, const RenderOptions& options = {});

}  // namespace pbnbrdf
