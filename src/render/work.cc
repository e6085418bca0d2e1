#include "pbnbrdf/render/work.h"

#include <numeric>

namespace pbnbrdf {

std::int64_t Work::AllSkipped() const {
  return std::accumulate(skipped.begin(), skipped.end(), std::int64_t{0});
}

std::optional<double> Work::SecondsSavedEstimate() const {
  if (AllSkipped() == 0) return 0.0;
  if (done == 0) return std::nullopt;
  return seconds / static_cast<double>(done) * static_cast<double>(AllSkipped());
}

Work& Work::operator+=(const Work& other) {
  needed += other.needed;
  done += other.done;
  for (std::size_t i = 0; i < skipped.size(); ++i) skipped[i] += other.skipped[i];
  seconds += other.seconds;
  return *this;
}

RenderWork& RenderWork::operator+=(const RenderWork& other) {
  for (const WorkKind& kind : WorkKinds()) this->*kind.work += other.*kind.work;
  return *this;
}

const std::vector<WorkKind>& WorkKinds() {
  using enum SkipReason;
  static const std::vector<WorkKind> kinds = {
      {"materials", &RenderWork::materials, {kUnreferenced, kNotReached}},
      {"samples", &RenderWork::samples, {kConverged}},
      {"path_vertices", &RenderWork::path_vertices, {kEnded}},
      {"rays", &RenderWork::rays, {kBelowHorizon, kUnlit, kEmptyTiles}},
      {"brdf_values", &RenderWork::brdf_values, {kBelowHorizon, kOccluded, kUnlit}}};
  return kinds;
}

}  // namespace pbnbrdf
