#include "render_summary.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace pbnbrdf::cli {
namespace {

// The reasons that a kind of work may be skipped for are shown even where they are 0.
struct Kind {
  const char* key;
  Work RenderWork::*work;
  std::vector<SkipReason> reasons;
};

std::vector<Kind> Kinds() {
  using enum SkipReason;
  return {{"materials", &RenderWork::materials, {kUnreferenced, kNotReached}},
          {"samples", &RenderWork::samples, {kConverged}},
          {"lanes", &RenderWork::lanes, {kEnded}},
          {"rays", &RenderWork::rays, {kBelowHorizon, kUnlit, kEmptyTiles}},
          {"brdf_values", &RenderWork::brdf_values, {kBelowHorizon, kOccluded, kUnlit}}};
}

}  // namespace

nlohmann::ordered_json WorkJson(const Work& work, const std::vector<SkipReason>& reasons) {
  nlohmann::ordered_json json = {{"needed", work.needed}, {"done", work.done}};
  for (const SkipReason reason : reasons) {
    json["skipped"][std::string(NameOf(kSkipReasons, reason))] = work.Skipped(reason);
  }
  json["seconds"] = work.seconds;
  const std::optional<double> saved = work.SecondsSavedEstimate();
  json["seconds_saved_estimate"] = saved ? nlohmann::ordered_json(*saved) : nullptr;
  return json;
}

std::string WorkText(const std::string& kind, const Work& work,
                     const std::vector<SkipReason>& reasons) {
  std::ostringstream text;
  text << "  " << std::left << std::setw(12) << kind << work.done << " done";
  if (work.needed != work.done) text << ", " << work.needed << " needed";
  text << "; skipped:";
  for (const SkipReason reason : reasons) {
    text << (reason == reasons.front() ? " " : ", ") << work.Skipped(reason) << " "
         << NameOf(kSkipReasons, reason);
  }
  const std::optional<double> saved = work.SecondsSavedEstimate();
  if (saved && *saved > 0.0) {
    text << " (saved about " << std::setprecision(2) << *saved << " s of one thread)";
  }
  text << "\n";
  return text.str();
}

nlohmann::ordered_json ToJson(const RenderSummary& summary) {
  nlohmann::ordered_json json = {{"image_samples", summary.samples},
                                 {"dropped_samples", summary.dropped_samples},
                                 {"stopped", summary.stopped},
                                 {"seconds", summary.seconds}};
  for (const Kind& kind : Kinds()) {
    json[kind.key] = WorkJson(summary.work.*kind.work, kind.reasons);
  }
  return json;
}

std::string WorkText(const RenderWork& work) {
  std::string text;
  for (const Kind& kind : Kinds()) text += WorkText(kind.key, work.*kind.work, kind.reasons);
  return text;
}

}  // namespace pbnbrdf::cli
