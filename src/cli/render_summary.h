// render_summary.h: the counts of a render's work (render/work.h), as JSON and as text.
#pragma once

#include <string>
#include <vector>

#include "command_line.h"
#include "pbnbrdf/render/render.h"
#include "pbnbrdf/render/scene.h"

namespace pbnbrdf::cli {

// "needed", "done", "skipped" (an object with each of the reasons), "seconds" that the work done took,
// summed over threads, and "seconds_saved_estimate", null if none was done.
Json WorkJson(const Work& work, const std::vector<SkipReason>& reasons);

// The same, as a line.
std::string WorkText(const std::string& kind, const Work& work,
                     const std::vector<SkipReason>& reasons);

// "image_samples", "dropped_samples", "stopped", "seconds", and a WorkJson for each kind of work.
Json ToJson(const RenderSummary& summary);

// A line for each kind of work.
std::string WorkText(const RenderWork& work);

// ReadScene. What it leaves out of meshes is said on standard error, a line for each shape.
Scene ReadSceneAndTell(const std::string& path, const SceneChanges& changes = {});

}  // namespace pbnbrdf::cli
