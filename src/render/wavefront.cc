#include "wavefront.h"

#include <cmath>

#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {
namespace {

// A tangent nearer to the normal than this, in radians, is mostly rounding.
constexpr double kMinAngle = 1e-6;

Frame MakeFrame(const Vec3& normal, const Vec3& tangent) {
  Vec3 x = tangent - Dot(tangent, normal) * normal;
  if (!(Length(x) > kMinAngle * Length(tangent))) {
    const Vec3 other = std::abs(normal.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    x = other - Dot(other, normal) * normal;
  }
  x = Normalized(x);
  return {x, Cross(normal, x), normal};
}

constexpr Rgb kWhite = {1.0, 1.0, 1.0};

}  // namespace

Vertex MakeVertex(const Hit& hit, std::size_t path, const Vec3& direction) {
  const Vec3 to_viewer = -1.0 * direction;
  const auto towards = [](const Vec3& side, const Vec3& v) {
    return Dot(v, side) < 0.0 ? -1.0 * v : v;
  };
  const Vec3 normal = towards(to_viewer, hit.normal);
  Vec3 shading_normal = towards(normal, hit.shading_normal);
  // Interpolation may turn it away from a viewer who sees the triangle.
  if (!(Dot(shading_normal, to_viewer) > 0.0)) shading_normal = normal;
  const Frame frame = MakeFrame(shading_normal, hit.tangent);
  return {path, hit.material, hit.position, normal, frame, frame.ToLocal(to_viewer), hit.margin};
}

void RequestLog::AddLight(int material, const DirectionPair& pair, const Rgb& value,
                          const Rgb& arriving) {
  const Rgb reflectance = pair.wi.z * value;
  const Rgb change = (kWhite + reflectance) * arriving;
  Keep({material, pair, Luminance(reflectance * arriving), Luminance(change)});
}

void RequestLog::Continue(std::size_t path, int material, const DirectionPair& pair,
                          const Rgb& value, const Rgb& radiance) {
  reflections_.push_back({path, material, pair, value, radiance});
}

void RequestLog::EndPaths(std::span<const Path> paths) {
  for (const auto& [path, material, pair, value, radiance] : reflections_) {
    const Rgb later = paths[path].radiance - radiance, reflectance = pair.wi.z * value;
    Rgb change = {};
    for (std::size_t c = 0; c < 3; ++c) {
      if (reflectance[c] > 0.0) change[c] = later[c] * (1.0 + reflectance[c]) / reflectance[c];
    }
    Keep({material, pair, Luminance(later), Luminance(change)});
  }
  reflections_.clear();
}

void RequestLog::Keep(const Request& request) {
  const bool finite = std::isfinite(request.luminance) && std::isfinite(request.sensitivity);
  if (finite && request.sensitivity > 0.0) requests_.push_back(request);
}

RayEnd Wavefront::Follow(const Ray& ray, int reflections, double pdf, bool trace) const {
  RayEnd end;
  const bool hits = trace && geometry.Intersect(ray, &end.hit);
  if (hits && end.hit.light < 0) {
    if (reflections < options.max_bounces) end.kind = RayEnd::Kind::kSurface;
    return end;
  }
  const bool reflected = reflections > 0;
  if (reflected && options.estimator == Estimator::kLight) return end;
  const Hit* light = hits ? &end.hit : nullptr;
  end.radiance = lights.Radiance(ray, light);
  if (end.radiance == Rgb{}) return end;
  end.kind = RayEnd::Kind::kLight;
  if (reflected && options.estimator == Estimator::kMis) {
    end.weight = PowerHeuristic(pdf, lights.Pdf(ray, light));
  }
  return end;
}

void Wavefront::Arrive(std::size_t path, const Ray& ray, const RayEnd& end) {
  if (end.kind == RayEnd::Kind::kSurface) {
    reached.push_back(MakeVertex(end.hit, path, ray.direction));
  } else if (end.kind == RayEnd::Kind::kLight) {
    Path& to = paths[path];
    to.radiance = to.radiance + end.weight * to.throughput * end.radiance;
  }
}

}  // namespace pbnbrdf
