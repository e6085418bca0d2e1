// render.h: renders scenes by path tracing.
//
// At each vertex of a path one light, chosen uniformly, is sampled, and the material's
// ImportanceSampler draws the path's next direction. Both are combined by multiple importance sampling
// with the power heuristic [1]. Russian roulette ends paths after a few reflections.
//
// The paths of a tile take each step together. BRDF values are requested one material at a time,
// hundreds at once, which is what makes networks fast.
//
// Work that cannot change the image is skipped, and counted (work.h): opening materials that no path
// hits, rays through tiles without shapes, and BRDF values for directions below the horizon, for
// hidden lights, and for rays that lead to no light. That is why a ray is traced before the BRDF at its
// origin is evaluated.
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
  // The density that directions are drawn with; fitted to the BRDF if absent. Materials with the same
  // proposal send paths in the same directions, until Russian roulette ends some: their images have
  // the same noise, and can be compared.
  std::optional<Proposal> proposal = {};
};

// Opens the material that a SceneMaterial's source names; throws Error. Called when the first path hits
// the material, by any thread, but by one at a time.
using MaterialOpener = std::function<OpenedMaterial(const std::string& source)>;

// Which techniques find light: sampling the BRDF, sampling lights, or both. The images differ in noise
// only. Point and directional lights are always sampled, as no ray hits them.
enum class Estimator { kMis, kBrdf, kLight };

inline constexpr NameTable<Estimator, 3> kEstimators = {
    {{"mis", Estimator::kMis}, {"brdf", Estimator::kBrdf}, {"light", Estimator::kLight}}};

struct RenderProgress {
  double fraction;  // of the samples, including those that target_error saves
  double seconds;
};

struct RenderOptions {
  int samples_per_pixel = 256;  // >= 1, uniform in the pixel
  std::uint64_t seed = 1;
  int threads = 0;       // 0: one for each core; the image does not depend on it
  int max_bounces = 64;  // reflections of a path, 0 to 100,000; 0: only lights are visible
  Estimator estimator = Estimator::kMis;
  // Adaptive sampling: a block of 4 x 4 pixels gets no more samples when each of its pixels has at
  // least 32, and a standard error of its mean luminance, estimated from its samples, below
  // target_error (mean luminance + 0.01). Checked every 16 samples. Finite, >= 0; 0: off. Stopping by
  // what was sampled makes pixels slightly too dark, by less than the error itself.
  double target_error = 0.0;
  // Skip work that cannot change the image. false: do it all the same, for comparison: the image
  // stays the same, bit for bit. target_error is independent of this.
  bool skip = true;
  // Called after each tile, by one thread at a time. If it returns false, Render stops and returns the
  // image so far.
  std::function<bool(const RenderProgress&)> on_progress = {};
};

struct RenderSummary {
  bool stopped = false;              // by on_progress
  std::int64_t samples = 0;          // in the image
  std::int64_t dropped_samples = 0;  // whose radiance was not finite; not in the image
  RenderWork work;
  double seconds = 0.0;  // of Render, including the opening of materials
};

struct Rendering {
  Image image;  // mean radiance of each pixel's samples; black where there are none
  std::vector<std::int64_t> samples;  // of each pixel, in its mean; row by row
  RenderSummary summary;
};

// Throws Error "RenderOptions::threads = -1; must be >= 0".
void ValidateRender(const RenderOptions& options);

// Opens each material when the first path hits it (without `skip` all of them at the start), and
// renders. The same arguments give the same image, bit for bit.
//
// Throws Error if an option is out of its range or a material can't be opened ("materials.gold: ...").
// The latter at the end of the pass over the image in which a path hit it, for the first such material
// of the scene. A material that few paths hit may fail late.
Rendering Render(const Scene& scene, const MaterialOpener& open, const RenderOptions& options = {});

}  // namespace pbnbrdf
