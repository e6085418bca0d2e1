#include "path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pbnbrdf {
namespace {

// Reflections before Russian roulette begins.
constexpr int kSureBounces = 4;

struct Path {
  Random random;
  Ray ray;
  Rgb throughput = {1.0, 1.0, 1.0};
  Rgb radiance = {};
  double pdf = 0.0;  // with which the material chose the ray's direction
  std::size_t pixel = 0;
};

// A right-handed orthonormal frame; z is the normal.
struct Frame {
  Vec3 x, y, z;

  Vec3 ToLocal(const Vec3& v) const { return {Dot(v, x), Dot(v, y), Dot(v, z)}; }
  Vec3 ToWorld(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

// Where a path is reflected. The normals are on the viewer's side.
struct Vertex {
  std::size_t path;
  int material;
  Vec3 position, normal;
  Frame frame;  // about the shading normal
  Vec3 wo;      // to the viewer, in the frame
  double margin;

  // The start of a ray that leaves on the viewer's side.
  Ray RayTo(const Vec3& direction) const { return {position + margin * normal, direction}; }
};

Frame MakeFrame(const Vec3& normal, const Vec3& tangent) {
  Vec3 x = tangent - Dot(tangent, normal) * normal;
  if (!(Length(x) > 1e-6 * Length(tangent))) {  // along the normal: any other will do
    const Vec3 other = std::abs(normal.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    x = other - Dot(other, normal) * normal;
  }
  x = Normalized(x);
  return {x, Cross(normal, x), normal};
}

Vertex MakeVertex(const Hit& hit, std::size_t path, const Vec3& direction) {
  const Vec3 to_viewer = -1.0 * direction;
  Vertex vertex;
  vertex.path = path;
  vertex.material = hit.material;
  vertex.position = hit.position;
  vertex.margin = hit.margin;
  vertex.normal = Dot(hit.normal, to_viewer) < 0.0 ? -1.0 * hit.normal : hit.normal;
  // An interpolated normal may be turned away from a viewer who sees the triangle.
  Vec3 shading =
      Dot(hit.shading_normal, vertex.normal) < 0.0 ? -1.0 * hit.shading_normal : hit.shading_normal;
  if (!(Dot(shading, to_viewer) > 0.0)) shading = vertex.normal;
  vertex.frame = MakeFrame(shading, hit.tangent);
  vertex.wo = vertex.frame.ToLocal(to_viewer);
  return vertex;
}

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
  TilePaths(const PathTracer& tracer, TileCounts* counts) : t_(tracer), counts_(counts) {}

  void Start(const Tile& tile, int first, int count) {
    const int image_width = t_.scene_.film.width;
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        for (int sample = first; sample < first + count; ++sample) {
          Path path;
          path.pixel = std::size_t(y) * std::size_t(image_width) + std::size_t(x);
          path.random = Random(t_.options_.seed, path.pixel, std::uint64_t(sample));
          path.ray = t_.CameraRay(x, y, &path.random);
          active_.push_back(paths_.size());
          paths_.push_back(path);
        }
      }
    }
  }

  void Follow() {
    for (bounce_ = 0; !active_.empty(); ++bounce_) {
      FindVertices();
      active_.clear();
      std::stable_sort(vertices_.begin(), vertices_.end(),
                       [](const Vertex& a, const Vertex& b) { return a.material < b.material; });
      for (auto begin = vertices_.begin(); begin != vertices_.end();) {
        const auto end = std::find_if(begin, vertices_.end(), [&](const Vertex& vertex) {
          return vertex.material != begin->material;
        });
        Shade({begin, end});
        begin = end;
      }
    }
  }

  void Deposit(std::span<PixelSum> pixels) const {
    for (const Path& path : paths_) {
      if (!IsFinite(path.radiance)) {
        ++counts_->dropped_samples;
        continue;
      }
      PixelSum& pixel = pixels[path.pixel];
      for (int c = 0; c < 3; ++c) pixel.radiance[c] += path.radiance[c];
      ++pixel.samples;
    }
  }

 private:
  // Follows the rays of the active paths: adds the lights that they meet, keeps where they are
  // reflected.
  void FindVertices() {
    vertices_.clear();
    for (const std::size_t i : active_) {
      Path& path = paths_[i];
      const Vec3& direction = path.ray.direction;
      Hit hit;
      ++counts_->rays;
      if (!t_.geometry_.Intersect(path.ray, &hit)) {
        AddEmission(
            t_.lights_.EnvironmentRadiance(direction),
            [&] { return t_.lights_.EnvironmentPdf(direction); }, &path);
      } else if (hit.light >= 0) {
        AddEmission(
            t_.lights_.RectangleRadiance(hit.light, direction),
            [&] {
              return t_.lights_.RectanglePdf(hit.light, path.ray.origin, direction, hit.position);
            },
            &path);
      } else if (bounce_ < t_.options_.max_bounces) {
        vertices_.push_back(MakeVertex(hit, i, direction));
      }
    }
  }

  // light_pdf(): the density with which the light would have been sampled.
  template <typename Pdf>
  void AddEmission(const Rgb& radiance, Pdf light_pdf, Path* path) const {
    double weight = 1.0;
    if (bounce_ > 0 && t_.options_.estimator == Estimator::kLight) return;
    if (bounce_ > 0 && t_.options_.estimator == Estimator::kMis) {
      weight = PowerHeuristic(path->pdf, light_pdf());
    }
    for (int c = 0; c < 3; ++c) path->radiance[c] += weight * path->throughput[c] * radiance[c];
  }

  // Reflects paths on one material: light sampled, and the direction in which the path goes on.
  void Shade(std::span<const Vertex> vertices) {
    const OpenMaterial& material = t_.materials_[std::size_t(vertices.front().material)];
    pairs_.clear();
    lit_.clear();
    going_on_.clear();
    SampleLights(vertices);
    SampleDirections(vertices, *material.sampler);
    values_.resize(pairs_.size());
    material.brdf->Evaluate(pairs_, values_);
    counts_->brdf_values += static_cast<std::int64_t>(pairs_.size());
    AddLight(vertices, *material.sampler);
    GoOn(vertices);
  }

  // Lights that arrive at the vertices, to pairs_ and lit_.
  void SampleLights(std::span<const Vertex> vertices) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vertex& vertex = vertices[i];
      LightSample light;
      if (!t_.lights_.Sample(vertex.position, &paths_[vertex.path].random, &light)) continue;
      const Vec3 wi = vertex.frame.ToLocal(light.direction);
      if (!(wi.z > 0.0) || !(Dot(light.direction, vertex.normal) > 0.0)) continue;
      if (light.weight == Rgb{}) continue;
      ++counts_->rays;
      if (t_.geometry_.Occluded(vertex.RayTo(light.direction), light.distance)) continue;
      pairs_.push_back({wi, vertex.wo});
      lit_.push_back({i, light.weight, light.pdf});
    }
  }

  // Directions that the material chooses, to pairs_ and going_on_, after the lights.
  void SampleDirections(std::span<const Vertex> vertices, const ImportanceSampler& sampler) {
    const std::size_t n = vertices.size();
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
      const Vec3 world = vertices[i].frame.ToWorld(directions_[i]);
      if (!(pdfs_[i] > 0.0) || !(Dot(world, vertices[i].normal) > 0.0)) continue;
      pairs_.push_back({directions_[i], vertices[i].wo});
      going_on_.push_back(i);
    }
  }

  // The light sampled, times what the material makes of it.
  void AddLight(std::span<const Vertex> vertices, const ImportanceSampler& sampler) {
    viewed_.clear();
    for (std::size_t k = 0; k < lit_.size(); ++k) viewed_.push_back(Swapped(pairs_[k]));
    light_pdfs_.resize(lit_.size());
    if (t_.options_.estimator == Estimator::kMis) sampler.Pdf(viewed_, light_pdfs_);
    for (std::size_t k = 0; k < lit_.size(); ++k) {
      const Lit& lit = lit_[k];
      double weight = pairs_[k].wi.z;
      if (t_.options_.estimator == Estimator::kMis && lit.pdf > 0.0) {
        weight *= PowerHeuristic(lit.pdf, light_pdfs_[k]);
      }
      Path& path = paths_[vertices[lit.vertex].path];
      for (int c = 0; c < 3; ++c) {
        path.radiance[c] += path.throughput[c] * values_[k][c] * weight * lit.weight[c];
      }
    }
  }

  // Sends the paths on in the directions chosen.
  void GoOn(std::span<const Vertex> vertices) {
    for (std::size_t k = 0; k < going_on_.size(); ++k) {
      const Vertex& vertex = vertices[going_on_[k]];
      const DirectionPair& pair = pairs_[lit_.size() + k];
      const Rgb& value = values_[lit_.size() + k];
      Path& path = paths_[vertex.path];
      path.pdf = pdfs_[going_on_[k]];
      for (int c = 0; c < 3; ++c) path.throughput[c] *= value[c] * pair.wi.z / path.pdf;
      if (!IsFinite(path.throughput)) {
        path.radiance.fill(std::numeric_limits<double>::quiet_NaN());  // dropped later
      } else if (Survives(&path)) {
        path.ray = vertex.RayTo(Normalized(vertex.frame.ToWorld(pair.wi)));
        active_.push_back(vertex.path);
      }
    }
  }

  bool Survives(Path* path) const {
    const double largest = *std::max_element(path->throughput.begin(), path->throughput.end());
    if (!(largest > 0.0)) return false;
    if (bounce_ < kSureBounces || largest >= 1.0) return true;
    if (!(path->random.Next() < largest)) return false;
    for (double& channel : path->throughput) channel /= largest;
    return true;
  }

  struct Lit {
    std::size_t vertex;
    Rgb weight;
    double pdf;
  };

  const PathTracer& t_;
  TileCounts* counts_;
  int bounce_ = 0;
  std::vector<Path> paths_;
  std::vector<std::size_t> active_;
  std::vector<Vertex> vertices_;

  // Of Shade: the lights' pairs first, then those of the directions to go on in.
  std::vector<DirectionPair> pairs_;
  std::vector<Rgb> values_;
  std::vector<Lit> lit_;
  std::vector<std::size_t> going_on_;
  std::vector<DirectionPair> viewed_;
  std::vector<Vec3> viewers_, directions_;
  std::vector<std::array<double, 2>> numbers_;
  std::vector<double> pdfs_, light_pdfs_;
};

PathTracer::PathTracer(const Scene& scene, const Geometry& geometry,
                       const std::vector<OpenMaterial>& materials, const RenderOptions& options)
    : scene_(scene),
      geometry_(geometry),
      materials_(materials),
      options_(options),
      lights_(scene, options.estimator) {
  const Camera& camera = scene.camera;
  const double half_width = std::tan(camera.field_of_view * std::numbers::pi / 360.0);
  const double half_height = half_width * scene.film.height / scene.film.width;
  forward_ = Normalized(camera.target - camera.origin);
  const Vec3 right = Normalized(Cross(forward_, camera.up));
  right_ = half_width * right;
  up_ = half_height * Cross(right, forward_);
}

Ray PathTracer::CameraRay(int x, int y, Random* random) const {
  const auto [dx, dy] = random->Pair();
  const double across = 2.0 * (x + dx) / scene_.film.width - 1.0;
  const double down = 2.0 * (y + dy) / scene_.film.height - 1.0;
  return {scene_.camera.origin, Normalized(forward_ + across * right_ - down * up_)};
}

void PathTracer::Trace(const Tile& tile, int first, int count, std::span<PixelSum> pixels,
                       TileCounts* counts) const {
  TilePaths paths(*this, counts);
  paths.Start(tile, first, count);
  paths.Follow();
  paths.Deposit(pixels);
}

}  // namespace pbnbrdf
