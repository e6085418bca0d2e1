#include "wavefront.h"

namespace pbnbrdf {

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
