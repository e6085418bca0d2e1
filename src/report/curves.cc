#include "report/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <tuple>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kIncident[] = {15.0, 45.0, 60.0, 75.0};                                // degrees
constexpr double kDifference[] = {5.0, 30.0, 60.0, 80.0};                               // degrees
constexpr double kLastElevation = 89.0, kElevationStep = 2.0;                           // degrees
constexpr double kAboutMirror[] = {0.0, 0.1, 0.25, 0.5, 0.8, 1.2, 1.7, 2.5, 3.5, 5.0};  // degrees
constexpr int kHalfAngles = 60;
constexpr double kNearCurve = 1.25;  // degrees, of a measurement from a curve that it is shown with
constexpr std::size_t kMaxMeasured = 150;    // measurements shown with a curve
constexpr double kLastMaterialAngle = 85.0;  // degrees; nearer to the horizon there are no data

// wi at phi = 0; wo on the other side of the normal where theta_o is positive.
DirectionPair InPlane(double theta_i, double theta_o) {
  return {FromSpherical(theta_i * kDegree, 0.0), FromSpherical(-theta_o * kDegree, 0.0)};
}

void Evaluate(const std::vector<DirectionPair>& pairs, const Brdf& material, const Brdf& fit,
              PlotCurve* curve) {
  curve->material.resize(pairs.size());
  curve->fit.resize(pairs.size());
  material.Evaluate(pairs, curve->material);
  fit.Evaluate(pairs, curve->fit);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (!material.IsKnown(pairs[n])) curve->material[n] = {kUnknown, kUnknown, kUnknown};
  }
}

// The angle at which the material was measured that is nearest to the given one, in degrees.
double MeasuredIncident(const Brdf& material, double angle) {
  double nearest = angle, distance = std::numeric_limits<double>::infinity();
  for (const double radians : material.IncidentAngles()) {
    const double measured = radians / kDegree;
    if (measured >= kLastMaterialAngle || std::abs(measured - angle) >= distance) continue;
    nearest = measured;
    distance = std::abs(measured - angle);
  }
  return nearest;
}

// theta_o in degrees if the pair is near the curve of theta_i, else NaN.
double PlaceInPlane(const DirectionPair& pair, double theta_i) {
  if (!pair.AboveHorizon() || std::abs(Theta(pair.wi) / kDegree - theta_i) > kNearCurve) {
    return kUnknown;
  }
  // The plane's normal is horizontal; where wi is the normal of the surface, any plane will do.
  const double sine = std::hypot(pair.wi.x, pair.wi.y);
  if (sine < 1e-6) return Theta(pair.wo) / kDegree;
  const double along = (pair.wi.x * pair.wo.x + pair.wi.y * pair.wo.y) / sine;
  const double beside = (pair.wi.x * pair.wo.y - pair.wi.y * pair.wo.x) / sine;
  if (std::abs(std::asin(std::clamp(beside, -1.0, 1.0))) > kNearCurve * kDegree) return kUnknown;
  return -std::atan2(along, pair.wo.z) / kDegree;
}

// Points are kept by place, evenly thinned if there are many.
void KeepMeasured(std::vector<std::pair<double, Rgb>> points, PlotCurve* curve) {
  std::sort(points.begin(), points.end());
  const std::size_t stride = points.size() / kMaxMeasured + 1;
  for (std::size_t n = 0; n < points.size(); n += stride) {
    curve->measured_x.push_back(points[n].first);
    curve->measured.push_back(points[n].second);
  }
}

// Of a list of measurements those near the curve; of a table the entries next to its points.
void AddMeasured(const Brdf& material, const std::vector<BrdfSample>& list,
                 const std::vector<DirectionPair>& pairs, PlotCurve* curve) {
  std::vector<std::pair<double, Rgb>> points;
  const auto add = [&](const DirectionPair& pair, const Rgb& value) {
    const bool turned = !material.IsIsotropic() && std::abs(pair.wi.y) > kNearCurve * kDegree;
    const double place = turned ? kUnknown : PlaceInPlane(pair, curve->angle);
    if (!std::isnan(place)) points.push_back({place, value});
  };
  for (const BrdfSample& sample : list) add(sample.pair, sample.value);
  std::set<std::tuple<double, double, double, double>> known;
  for (std::size_t n = 0; list.empty() && n < pairs.size(); ++n) {
    const auto pair = material.NearestMeasured(pairs[n]);
    if (!pair || !material.IsKnown(*pair)) continue;
    if (!known.insert({pair->wi.x, pair->wi.z, pair->wo.x, pair->wo.z}).second) continue;
    Rgb value;
    material.Evaluate({&*pair, 1}, {&value, 1});
    add(*pair, value);
  }
  KeepMeasured(std::move(points), curve);
}

// Degrees, dense about the mirror direction, where lobes are.
std::vector<double> Elevations(double mirror) {
  std::vector<double> all;
  for (double x = -kLastElevation; x <= kLastElevation; x += kElevationStep) all.push_back(x);
  for (const double offset : kAboutMirror) {
    for (const double x : {mirror - offset, mirror + offset}) {
      if (std::abs(x) < kLastElevation) all.push_back(x);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

std::vector<PlotCurve> InPlaneCurves(const Brdf& material, const Brdf& fit) {
  const std::vector<BrdfSample> list = material.Measurements();
  std::vector<PlotCurve> curves;
  for (const double wanted : kIncident) {
    PlotCurve curve;
    curve.angle = MeasuredIncident(material, wanted);
    if (!curves.empty() && curves.back().angle == curve.angle) continue;
    curve.x = Elevations(curve.angle);
    std::vector<DirectionPair> pairs;
    for (const double x : curve.x) pairs.push_back(InPlane(curve.angle, x));
    Evaluate(pairs, material, fit, &curve);
    AddMeasured(material, list, pairs, &curve);
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<PlotCurve> HalfAngleCurves(const Brdf& material, const Brdf& fit) {
  std::vector<PlotCurve> curves;
  for (const double angle : kDifference) {
    PlotCurve curve;
    curve.angle = angle;
    std::vector<DirectionPair> pairs;
    for (int n = 0; n < kHalfAngles; ++n) {
      const double u = n / (kHalfAngles - 1.0), x = 90.0 * u * u;
      const DirectionPair pair =
          FromAngles({.theta_h = x * kDegree, .theta_d = angle * kDegree, .phi_d = 90.0 * kDegree});
      if (!pair.AboveHorizon()) break;
      curve.x.push_back(x);
      pairs.push_back(pair);
    }
    Evaluate(pairs, material, fit, &curve);
    curves.push_back(std::move(curve));
  }
  return curves;
}

AlbedoCurves MeasureAlbedoCurves(const Brdf& material, const Brdf& fit) {
  AlbedoCurves curves;
  for (const double degrees : {0.0,  5.0,  10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0,
                               50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 87.0, 89.0}) {
    const Vec3 wi = FromSpherical(degrees * kDegree, 0.0);
    curves.theta_i.push_back(degrees);
    curves.fit.push_back(DirectionalAlbedo(fit, wi, 64, 32));
    curves.material.push_back(degrees <= kLastMaterialAngle
                                  ? DirectionalAlbedo(material, wi, 64, 32)
                                  : Rgb{kUnknown, kUnknown, kUnknown});
  }
  return curves;
}

}  // namespace pbnbrdf
