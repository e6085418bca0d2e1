#include "lights.h"

#include <limits>

namespace pbnbrdf {
namespace {

// Shadow rays end this much before a rectangle light, which is there to be hit.
constexpr double kShorter = 1.0 - 1e-4;

Rgb Scaled(const Rgb& color, double factor) {
  return {color[0] * factor, color[1] * factor, color[2] * factor};
}

// x axis times y axis: of the length of a quarter of the area.
Vec3 AreaNormal(const RectangleLight& light) { return Cross(light.x_axis, light.y_axis); }

}  // namespace

Lights::Lights(const Scene& scene, Estimator estimator) : scene_(scene) {
  if (estimator != Estimator::kBrdf) {
    if (scene.environment && !scene.environment->IsBlack()) {
      choices_.push_back({Kind::kEnvironment, 0});
    }
    for (std::size_t i = 0; i < scene.rectangle_lights.size(); ++i) {
      choices_.push_back({Kind::kRectangle, i});
    }
  }
  for (std::size_t i = 0; i < scene.point_lights.size(); ++i) choices_.push_back({Kind::kPoint, i});
  for (std::size_t i = 0; i < scene.directional_lights.size(); ++i) {
    choices_.push_back({Kind::kDirectional, i});
  }
}

bool Lights::Sample(const Vec3& position, Random* random, LightSample* sample) const {
  if (choices_.empty()) return false;
  const auto count = static_cast<double>(choices_.size());
  const Choice choice = choices_[static_cast<std::size_t>(random->Next() * count)];
  switch (choice.kind) {
    case Kind::kEnvironment: {
      double pdf;
      Rgb radiance;
      sample->direction = scene_.environment->Sample(random->Pair(), &pdf, &radiance);
      sample->distance = std::numeric_limits<double>::infinity();
      sample->pdf = pdf / count;
      sample->weight = Scaled(radiance, 1.0 / sample->pdf);
      return true;
    }
    case Kind::kRectangle:
      return SampleRectangle(scene_.rectangle_lights[choice.number], position, random, sample);
    case Kind::kPoint: {
      const PointLight& light = scene_.point_lights[choice.number];
      const Vec3 to_light = light.position - position;
      const double squared = Dot(to_light, to_light);
      if (!(squared > 0.0)) return false;
      sample->distance = std::sqrt(squared);
      sample->direction = (1.0 / sample->distance) * to_light;
      sample->pdf = 0.0;
      sample->weight = Scaled(light.intensity, count / squared);
      return true;
    }
    case Kind::kDirectional: {
      const DirectionalLight& light = scene_.directional_lights[choice.number];
      sample->direction = -1.0 * light.direction;
      sample->distance = std::numeric_limits<double>::infinity();
      sample->pdf = 0.0;
      sample->weight = Scaled(light.irradiance, count);
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
  sample->direction = (1.0 / distance) * to_light;
  sample->distance = kShorter * distance;
  const double facing = -4.0 * Dot(AreaNormal(light), sample->direction);  // area times cosine
  if (!(facing > 0.0)) {
    sample->pdf = 0.0;
    sample->weight = {};
    return true;
  }
  sample->pdf = squared / (facing * static_cast<double>(choices_.size()));
  sample->weight = Scaled(light.radiance, 1.0 / sample->pdf);
  return true;
}

Rgb Lights::EnvironmentRadiance(const Vec3& direction) const {
  return scene_.environment ? scene_.environment->Radiance(direction) : Rgb{};
}

double Lights::EnvironmentPdf(const Vec3& direction) const {
  if (!scene_.environment || choices_.empty()) return 0.0;
  return scene_.environment->Pdf(direction) / static_cast<double>(choices_.size());
}

Rgb Lights::RectangleRadiance(int light, const Vec3& direction) const {
  const RectangleLight& rectangle = scene_.rectangle_lights[light];
  return Dot(AreaNormal(rectangle), direction) < 0.0 ? rectangle.radiance : Rgb{};
}

double Lights::RectanglePdf(int light, const Vec3& origin, const Vec3& direction,
                            const Vec3& position) const {
  const Vec3 way = position - origin;
  const double facing = -4.0 * Dot(AreaNormal(scene_.rectangle_lights[light]), direction);
  if (!(facing > 0.0) || choices_.empty()) return 0.0;
  return Dot(way, way) / (facing * static_cast<double>(choices_.size()));
}

}  // namespace pbnbrdf
