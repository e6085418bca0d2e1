#include "render_summary.h"

#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace pbnbrdf::cli {

Json WorkJson(const Work& work, const std::vector<SkipReason>& reasons) {
  Json json = {{"needed", work.needed}, {"done", work.done}};
  for (const SkipReason reason : reasons) {
    json["skipped"][std::string(NameOf(kSkipReasons, reason))] = work.Skipped(reason);
  }
  json["seconds"] = work.seconds;
  const std::optional<double> saved = work.SecondsSavedEstimate();
  json["seconds_saved_estimate"] = saved ? Json(*saved) : nullptr;
  return json;
}

std::string WorkText(const std::string& kind, const Work& work,
                     const std::vector<SkipReason>& reasons) {
  std::ostringstream text;
  text << "  " << std::left << std::setw(14) << kind << work.done << " done";
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

Json ToJson(const RenderSummary& summary) {
  Json json = {{"image_samples", summary.samples},
               {"dropped_samples", summary.dropped_samples},
               {"stopped", summary.stopped},
               {"seconds", summary.seconds}};
  for (const WorkKind& kind : WorkKinds()) {
    json[kind.name] = WorkJson(summary.work.*kind.work, kind.reasons);
  }
  return json;
}

std::string WorkText(const RenderWork& work) {
  std::string text;
  for (const WorkKind& kind : WorkKinds()) {
    text += WorkText(kind.name, work.*kind.work, kind.reasons);
  }
  return text;
}

Scene ReadSceneAndTell(const std::string& path, const SceneChanges& changes) {
  Scene scene = ReadScene(path, changes);
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const std::size_t left_out = scene.shapes[i].mesh.mesh.left_out;
    if (left_out == 0) continue;
    std::cerr << "pbnbrdf: " << path << ": shapes[" << i
              << "]: triangles without area left out: " << left_out << "\n";
  }
  return scene;
}

}  // namespace pbnbrdf::cli
