// small_scene.h: scenes with films as small as an experiment can do with.
#pragma once

#include <string>

#include "pbnbrdf/render/scene.h"

namespace pbnbrdf {

// The scene of a file, with a film of the given width, at least kSsimWindow, and the same proportions, but
// at least as high as images that are compared must be. environment: SceneChanges::environment. Throws Error
// as ReadScene does.
Scene ReadSmallScene(const std::string& path, const std::string& environment, int width);

}  // namespace pbnbrdf
