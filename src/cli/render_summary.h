// render_summary.h: what a render did and what it left out, as JSON and as text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pbnbrdf/render/render.h"

namespace pbnbrdf::cli {

// "image_samples", "dropped_samples", "stopped", "seconds", and for each kind of work (render/work.h) an
// object: "needed", "done", "skipped" by reason, "seconds" that what was done took, of all threads
// together, and "seconds_saved_estimate", null where nothing was done to estimate it by.
nlohmann::ordered_json ToJson(const RenderSummary& summary);

// A line for each kind of work.
std::string WorkText(const RenderWork& work);

}  // namespace pbnbrdf::cli
