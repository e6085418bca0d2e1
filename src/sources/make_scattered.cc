#include "sources/make_scattered.h"

#include <cmath>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kSameAngle = 1e-6;  // radians

}  // namespace

bool HaveOneIncidentAzimuth(std::span<const BrdfSample> samples) {
  const Vec3* first = nullptr;
  for (const BrdfSample& sample : samples) {
    const Vec3& wi = sample.pair.wi;
    if (std::hypot(wi.x, wi.y) < kSameAngle) continue;
    if (first == nullptr) first = &wi;
    const double cross = first->x * wi.y - first->y * wi.x;
    if (std::abs(cross) > kSameAngle * std::hypot(first->x, first->y) * std::hypot(wi.x, wi.y)) {
      return false;
    }
  }
  return true;
}

ScatteredBrdf MakeScattered(const std::string& path, ScatteredData data) {
  try {
    return ScatteredBrdf(std::move(data));
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
}

}  // namespace pbnbrdf
