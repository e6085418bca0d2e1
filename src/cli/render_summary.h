// render_summary.h: what was done for a scene and what was left out, as JSON and as text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pbnbrdf/render/render.h"

namespace pbnbrdf::cli {

// One kind of work (render/work.h): "needed", "done", "skipped" by each of the reasons, "seconds" that
// what was done took, of all threads together, and "seconds_saved_estimate", null where nothing was
// done to estimate it by.
nlohmann::ordered_json WorkJson(const Work& work, const std::vector<SkipReason>& reasons);

// The same, a line.
std::string WorkText(const std::string& kind, const Work& work,
                     const std::vector<SkipReason>& reasons);

// "image_samples", "dropped_samples", "stopped", "seconds", and an object for each kind of work.
nlohmann::ordered_json ToJson(const RenderSummary& summary);

// A line for each kind of work.
std::string WorkText(const RenderWork& work);

}  // namespace pbnbrdf::cli
