#include "path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/timer.h"
#include "random.h"
#include "vertex.h"

namespace pbnbrdf {
namespace {

// Reflections before Russian roulette begins.
constexpr int kSureBounces = 4;

struct Path {
  Random random;
  Rgb throughput = {1.0, 1.0, 1.0};
  Rgb radiance = {};
  std::size_t pixel = 0;
};

// What is at the end of a ray.
struct Arrival {
  enum class Kind { kNothing, kLight, kSurface };

  Kind kind = Kind::kNothing;  // also where the path would end without a contribution
  Rgb radiance = {};           // of the light
  double weight = 1.0;         // of its having been met rather than sampled
  Hit hit;                     // on the surface
};

// Light that was sampled at a vertex, and what of it arrives.
struct Lit {
  std::size_t vertex;
  DirectionPair pair;
  LightSample light;
};

// A direction that the material chose at a vertex, and what is there.
struct Onward {
  std::size_t vertex;
  DirectionPair pair;
  double pdf;
  Ray ray = {};
  Arrival arrival = {};
};

// The weight of one of two techniques by the power heuristic, exponent 2.
double PowerHeuristic(double pdf, double other) {
  const double ratio = other / pdf;
  return 1.0 / (1.0 + ratio * ratio);
}

bool IsFinite(const Rgb& color) {
  return std::isfinite(color[0]) && std::isfinite(color[1]) && std::isfinite(color[2]);
}

}  // namespace

// The paths of one call of Trace.
class TilePaths {
 public:
  // log: null, or what the materials are asked for goes there.
  TilePaths(const PathTracer& tracer, TileCounts* counts, RequestLog* log)
      : t_(tracer), counts_(*counts), work_(counts->work), log_(log) {}

  void Start(const SampleRange& range) {
    const int image_width = t_.scene_.film.width;
    for (const PixelBlock& block : range.blocks) {
      for (int y = block.y; y < block.y + block.height; ++y) {
        for (int x = block.x; x < block.x + block.width; ++x) {
          const std::size_t pixel = std::size_t(y) * std::size_t(image_width) + std::size_t(x);
          for (int sample = range.first; sample < range.first + range.count; ++sample) {
            Path path;
            path.pixel = pixel;
            path.random = Random(t_.options_.seed, pixel, std::uint64_t(sample));
            const auto [dx, dy] = path.random.Pair();
            camera_rays_.push_back(t_.camera_.RayThrough(x + dx, y + dy));
            paths_.push_back(path);
          }
        }
      }
    }
    FollowCameraRays(range.empty);
  }

  void Follow() {
    for (bounce_ = 0; !vertices_.empty(); ++bounce_) {
      CountLanes(vertices_.size());
      std::stable_sort(vertices_.begin(), vertices_.end(),
                       [](const Vertex& a, const Vertex& b) { return a.material < b.material; });
      next_.clear();
      for (auto begin = vertices_.begin(); begin != vertices_.end();) {
        const auto end = std::find_if(begin, vertices_.end(), [&](const Vertex& vertex) {
          return vertex.material != begin->material;
        });
        Shade({begin, end});
        begin = end;
      }
      vertices_.swap(next_);
    }
  }

  void Deposit(std::span<PixelSum> pixels) {
    if (log_) EndLog();
    for (const Path& path : paths_) {
      if (IsFinite(path.radiance)) {
        pixels[path.pixel].Add(path.radiance);
      } else {
        ++counts_.dropped_samples;
      }
    }
    CountDone(paths_.size(), &work_.samples);
  }

  double seconds_opening() const { return seconds_opening_; }

 private:
  void EndLog() {
    std::vector<Rgb> radiance;
    for (const Path& path : paths_) radiance.push_back(path.radiance);
    log_->EndPaths(radiance);
  }

  // Of paths that haven't been reflected yet: adds the lights that they meet, keeps where they are
  // reflected.
  void FollowCameraRays(bool empty) {
    const bool skip = empty && t_.options_.skip;
    const ScopedTimer timer(&work_.rays.seconds);
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      const Ray& ray = camera_rays_[i];
      Hit hit;
      const bool met = !skip && t_.geometry_.Intersect(ray, &hit);
      const Arrival arrival = ArrivalOf(ray, met ? &hit : nullptr, 0, 0.0);
      Continue(i, ray, arrival, &vertices_);
    }
    CountLanes(paths_.size());
    const auto rays = static_cast<std::int64_t>(paths_.size());
    if (!empty) work_.rays.needed += rays;
    (skip ? work_.rays.Skipped(SkipReason::kEmptyTiles) : work_.rays.done) += rays;
  }

  // What a ray finds that has met `hit`, or nothing if that is null, after so many reflections; the
  // last of them chose its direction with the density pdf.
  Arrival ArrivalOf(const Ray& ray, const Hit* hit, int reflections, double pdf) const {
    Arrival arrival;
    if (hit != nullptr && hit->light < 0) {
      if (reflections == t_.options_.max_bounces) return arrival;
      arrival.kind = Arrival::Kind::kSurface;
      arrival.hit = *hit;
      return arrival;
    }
    const bool reflected = reflections > 0;
    if (reflected && t_.options_.estimator == Estimator::kLight) return arrival;
    const Lights& lights = t_.lights_;
    arrival.radiance = hit != nullptr ? lights.RectangleRadiance(hit->light, ray.direction)
                                      : lights.EnvironmentRadiance(ray.direction);
    if (arrival.radiance == Rgb{}) return arrival;
    arrival.kind = Arrival::Kind::kLight;
    if (reflected && t_.options_.estimator == Estimator::kMis) {
      // The density with which the light would have been sampled.
      const double light_pdf =
          hit != nullptr ? lights.RectanglePdf(hit->light, ray.origin, ray.direction, hit->position)
                         : lights.EnvironmentPdf(ray.direction);
      arrival.weight = PowerHeuristic(pdf, light_pdf);
    }
    return arrival;
  }

  // Adds the light that the path has come to, or puts the place where it is reflected on the list.
  void Continue(std::size_t path, const Ray& ray, const Arrival& arrival,
                std::vector<Vertex>* vertices) {
    if (arrival.kind == Arrival::Kind::kSurface) {
      vertices->push_back(MakeVertex(arrival.hit, path, ray.direction));
    } else if (arrival.kind == Arrival::Kind::kLight) {
      Path& to = paths_[path];
      for (int c = 0; c < 3; ++c) {
        to.radiance[c] += arrival.weight * to.throughput[c] * arrival.radiance[c];
      }
    }
  }

  // Reflects paths on one material: light is sampled, and the direction in which the path goes on.
  // Only when it is known what light arrives is the material asked how much of it is reflected.
  void Shade(std::span<const Vertex> vertices) {
    const PreparedMaterial* material = Reach(vertices.front().material);
    if (material == nullptr) return;
    unneeded_.clear();
    SampleLights(vertices);
    TraceShadowRays(vertices);
    SampleDirections(vertices, *material->sampler);
    TraceOnward();
    EvaluatePairs(*material->brdf);
    AddLight(vertices, *material->sampler);
    GoOn(vertices);
  }

  const PreparedMaterial* Reach(int material) {
    const ScopedTimer timer(&seconds_opening_);
    return t_.materials_.Reach(std::size_t(material));
  }

  // Lights that may arrive at the vertices, to lit_.
  void SampleLights(std::span<const Vertex> vertices) {
    lit_.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vertex& vertex = vertices[i];
      LightSample light;
      if (!t_.lights_.Sample(vertex.position, &paths_[vertex.path].random, &light)) continue;
      const DirectionPair pair = {vertex.frame.ToLocal(light.direction), vertex.wo};
      const bool above = pair.wi.z > 0.0 && Dot(light.direction, vertex.normal) > 0.0;
      if (above && light.weight != Rgb{}) {
        lit_.push_back({i, pair, light});
      } else {
        const SkipReason reason = above ? SkipReason::kUnlit : SkipReason::kBelowHorizon;
        LeaveOutValue(reason, pair);
        LeaveOutShadowRay(reason, vertex.RayTo(light.direction), light.distance);
      }
    }
  }

  // Takes those from lit_ which don't arrive.
  void TraceShadowRays(std::span<const Vertex> vertices) {
    const ScopedTimer timer(&work_.rays.seconds);
    CountDone(lit_.size(), &work_.rays);
    std::erase_if(lit_, [&](const Lit& lit) {
      const Ray ray = vertices[lit.vertex].RayTo(lit.light.direction);
      if (!t_.geometry_.Occluded(ray, lit.light.distance)) return false;
      LeaveOutValue(SkipReason::kOccluded, lit.pair);
      return true;
    });
  }

  // Directions that the material chooses, to onward_.
  void SampleDirections(std::span<const Vertex> vertices, const ImportanceSampler& sampler) {
    const std::size_t n = vertices.size();
    onward_.clear();
    viewers_.resize(n);
    numbers_.resize(n);
    directions_.resize(n);
    pdfs_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      viewers_[i] = vertices[i].wo;
      numbers_[i] = paths_[vertices[i].path].random.Pair();
    }
    sampler.Sample(viewers_, numbers_, directions_, pdfs_);
    for (std::size_t i = 0; i < n; ++i) {
      const Vertex& vertex = vertices[i];
      const Vec3 world = vertex.frame.ToWorld(directions_[i]);
      const DirectionPair pair = {directions_[i], vertex.wo};
      if (pdfs_[i] > 0.0 && Dot(world, vertex.normal) > 0.0) {
        onward_.push_back({i, pair, pdfs_[i], vertex.RayTo(Normalized(world))});
      } else {
        LeaveOutValue(SkipReason::kBelowHorizon, pair);
      }
    }
  }

  // Looks where the directions lead to, and takes those from onward_ that lead to nothing.
  void TraceOnward() {
    const ScopedTimer timer(&work_.rays.seconds);
    CountDone(onward_.size(), &work_.rays);
    std::erase_if(onward_, [&](Onward& onward) {
      Hit hit;
      const bool met = t_.geometry_.Intersect(onward.ray, &hit);
      onward.arrival = ArrivalOf(onward.ray, met ? &hit : nullptr, bounce_ + 1, onward.pdf);
      if (onward.arrival.kind != Arrival::Kind::kNothing) return false;
      LeaveOutValue(SkipReason::kUnlit, onward.pair);
      return true;
    });
  }

  // The pairs of lit_, then those of onward_, and in the end unneeded ones; all to values_.
  void EvaluatePairs(const Brdf& brdf) {
    pairs_.clear();
    for (const Lit& lit : lit_) pairs_.push_back(lit.pair);
    for (const Onward& onward : onward_) pairs_.push_back(onward.pair);
    CountDone(pairs_.size(), &work_.brdf_values);
    work_.brdf_values.done += static_cast<std::int64_t>(unneeded_.size());
    pairs_.insert(pairs_.end(), unneeded_.begin(), unneeded_.end());
    values_.resize(pairs_.size());
    if (pairs_.empty()) return;
    const ScopedTimer timer(&work_.brdf_values.seconds);
    brdf.Evaluate(pairs_, values_);
  }

  // The light sampled, times what the material makes of it.
  void AddLight(std::span<const Vertex> vertices, const ImportanceSampler& sampler) {
    const bool mis = t_.options_.estimator == Estimator::kMis;
    viewed_.clear();
    for (const Lit& lit : lit_) viewed_.push_back(Swapped(lit.pair));
    pdfs_.resize(lit_.size());
    if (mis) sampler.Pdf(viewed_, pdfs_);
    for (std::size_t k = 0; k < lit_.size(); ++k) {
      const Lit& lit = lit_[k];
      const double weight =
          mis && lit.light.pdf > 0.0 ? PowerHeuristic(lit.light.pdf, pdfs_[k]) : 1.0;
      Path& path = paths_[vertices[lit.vertex].path];
      Rgb arriving;
      for (int c = 0; c < 3; ++c) {
        arriving[c] = path.throughput[c] * weight * lit.light.weight[c];
        path.radiance[c] += values_[k][c] * lit.pair.wi.z * arriving[c];
      }
      if (log_) log_->AddLight(vertices[lit.vertex].material, lit.pair, values_[k], arriving);
    }
  }

  // Sends the paths on in the directions chosen.
  void GoOn(std::span<const Vertex> vertices) {
    for (std::size_t k = 0; k < onward_.size(); ++k) {
      const Onward& onward = onward_[k];
      const std::size_t i = vertices[onward.vertex].path;
      const Rgb& value = values_[lit_.size() + k];
      Path& path = paths_[i];
      for (int c = 0; c < 3; ++c) path.throughput[c] *= value[c] * onward.pair.wi.z / onward.pdf;
      if (!IsFinite(path.throughput)) {
        path.radiance.fill(std::numeric_limits<double>::quiet_NaN());  // dropped later
      } else if (Survives(&path)) {
        if (log_) {
          log_->GoOn(i, vertices[onward.vertex].material, onward.pair, value, path.radiance);
        }
        Continue(i, onward.ray, onward.arrival, &next_);
      }
    }
  }

  bool Survives(Path* path) const {
    const double largest = Largest(path->throughput);
    if (!(largest > 0.0)) return false;
    if (bounce_ < kSureBounces || largest >= 1.0) return true;
    if (!(path->random.Next() < largest)) return false;
    for (double& channel : path->throughput) channel /= largest;
    return true;
  }

  // A value that isn't needed: counted, or put where it is asked for and then forgotten.
  void LeaveOutValue(SkipReason reason, const DirectionPair& pair) {
    if (t_.options_.skip) {
      ++work_.brdf_values.Skipped(reason);
    } else {
      unneeded_.push_back(pair);
    }
  }

  // Likewise of a ray, which is traced right away.
  void LeaveOutShadowRay(SkipReason reason, const Ray& ray, double distance) {
    if (t_.options_.skip) {
      ++work_.rays.Skipped(reason);
      return;
    }
    const ScopedTimer timer(&work_.rays.seconds);
    t_.geometry_.Occluded(ray, distance);
    ++work_.rays.done;
  }

  void CountLanes(std::size_t going_on) {
    CountDone(going_on, &work_.lanes);
    work_.lanes.Skipped(SkipReason::kEnded) += static_cast<std::int64_t>(paths_.size() - going_on);
  }

  // Things that were needed.
  static void CountDone(std::size_t count, Work* work) {
    work->needed += static_cast<std::int64_t>(count);
    work->done += static_cast<std::int64_t>(count);
  }

  const PathTracer& t_;
  TileCounts& counts_;
  RenderWork& work_;
  RequestLog* log_;
  double seconds_opening_ = 0.0;
  int bounce_ = 0;  // reflections before those under way
  std::vector<Path> paths_;
  std::vector<Ray> camera_rays_;
  std::vector<Vertex> vertices_, next_;

  // Of Shade.
  std::vector<Lit> lit_;
  std::vector<Onward> onward_;
  std::vector<DirectionPair> pairs_, unneeded_, viewed_;
  std::vector<Rgb> values_;
  std::vector<Vec3> viewers_, directions_;
  std::vector<std::array<double, 2>> numbers_;
  std::vector<double> pdfs_;
};

PathTracer::PathTracer(const Scene& scene, const PinholeCamera& camera, const Geometry& geometry,
                       const RenderOptions& options, Materials* materials)
    : scene_(scene),
      camera_(camera),
      geometry_(geometry),
      options_(options),
      materials_(*materials),
      lights_(scene, options.estimator) {}

void PathTracer::Trace(const SampleRange& range, std::span<PixelSum> pixels, TileCounts* counts,
                       RequestLog* log) const {
  const Timer timer;
  TilePaths paths(*this, counts, log);
  paths.Start(range);
  paths.Follow();
  paths.Deposit(pixels);
  counts->work.samples.seconds += timer.Seconds() - paths.seconds_opening();
}

}  // namespace pbnbrdf
