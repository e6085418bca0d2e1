#include "lights.h"

#include <limits>

#include "rgb.h"

namespace pbnbrdf {
namespace {

// Shadow rays end this part of the way to a rectangle light: they must not hit the light itself. As
// pbrt's shadow rays do.
constexpr double kShadowRayPart = 1.0 - 1e-4;

constexpr double kInfinitelyFar = std::numeric_limits<double>::infinity();

// The area of the light times the cosine between its normal and the way back along `direction`.
double ProjectedArea(const RectangleLight& light, const Vec3& direction) {
  return -4.0 * Dot(Cross(light.x_axis, light.y_axis), direction);
}

}  // namespace

Lights::Lights(const Scene& scene, Estimator estimator) : scene_(scene) {
  const auto add = [&](Kind kind, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) choices_.push_back({kind, i});
  };
  if (estimator != Estimator::kBrdf) {
    add(Kind::kEnvironment, scene.environment && !scene.environment->IsBlack() ? 1 : 0);
    add(Kind::kRectangle, scene.rectangle_lights.size());
  }
  add(Kind::kPoint, scene.point_lights.size());
  add(Kind::kDirectional, scene.directional_lights.size());
}

bool Lights::Sample(const Vec3& position, Random* random, LightSample* sample) const {
  if (choices_.empty()) return false;
  const auto count = static_cast<double>(choices_.size());
  const Choice choice = choices_[static_cast<std::size_t>(random->Next() * count)];
  switch (choice.kind) {
    case Kind::kEnvironment: {
      double pdf;
      Rgb radiance;
      const Vec3 direction = scene_.environment->Sample(random->Pair(), &pdf, &radiance);
      pdf /= count;
      *sample = {direction, kInfinitelyFar, (1.0 / pdf) * radiance, pdf};
      return true;
    }
    case Kind::kRectangle:
      return SampleRectangle(scene_.rectangle_lights[choice.number], position, random, sample);
    case Kind::kPoint: {
      const PointLight& light = scene_.point_lights[choice.number];
      const Vec3 to_light = light.position - position;
      const double squared = Dot(to_light, to_light), distance = std::sqrt(squared);
      if (!(distance > 0.0)) return false;
      *sample = {(1.0 / distance) * to_light, distance, (count / squared) * light.intensity, 0.0};
      return true;
    }
    case Kind::kDirectional: {
      const DirectionalLight& light = scene_.directional_lights[choice.number];
      *sample = {-1.0 * light.direction, kInfinitelyFar, count * light.irradiance, 0.0};
      return true;
    }
  }
  return false;
}

bool Lights::SampleRectangle(const RectangleLight& light, const Vec3& position, Random* random,
                             LightSample* sample) const {
  const auto [u, v] = random->Pair();
  const Vec3 point = light.center + (2.0 * u - 1.0) * light.x_axis + (2.0 * v - 1.0) * light.y_axis;
  const Vec3 to_light = point - position;
  const double squared = Dot(to_light, to_light), distance = std::sqrt(squared);
  if (!(distance > 0.0)) return false;
  *sample = {(1.0 / distance) * to_light, kShadowRayPart * distance, {}, 0.0};
  const double area = ProjectedArea(light, sample->direction);
  if (area > 0.0) {
    sample->pdf = squared / (area * static_cast<double>(choices_.size()));
    sample->weight = (1.0 / sample->pdf) * light.radiance;
  }
  return true;
}

Rgb Lights::Radiance(const Ray& ray, const Hit* hit) const {
  if (hit == nullptr) {
    return scene_.environment ? scene_.environment->Radiance(ray.direction) : Rgb{};
  }
  const RectangleLight& light = scene_.rectangle_lights[static_cast<std::size_t>(hit->light)];
  return ProjectedArea(light, ray.direction) > 0.0 ? light.radiance : Rgb{};
}

double Lights::Pdf(const Ray& ray, const Hit* hit) const {
  const auto count = static_cast<double>(choices_.size());
  if (choices_.empty()) return 0.0;
  if (hit == nullptr) {
    return scene_.environment ? scene_.environment->Pdf(ray.direction) / count : 0.0;
  }
  const Vec3 way = hit->position - ray.origin;
  const double area =
      ProjectedArea(scene_.rectangle_lights[static_cast<std::size_t>(hit->light)], ray.direction);
  return area > 0.0 ? Dot(way, way) / (area * count) : 0.0;
}

}  // namespace pbnbrdf
