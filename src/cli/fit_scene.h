// fit_scene.h: pbnbrdf fit --scene: the materials of a scene, where it shows them.
#pragma once

#include "command_line.h"

namespace pbnbrdf::cli {

// --scene and what comes with it.
FlagGroup SceneFlags();

// Whether --scene is given. Throws UsageError if flags that only it has are given without it, or if
// there are others that don't go with it.
bool FitsScene();

// Fits a network to each material that the scene shows: OUT_DIR/MATERIAL.safetensors, and
// OUT_DIR/summary.json, which says what was needed and why. Throws Error.
int RunSceneFit();

}  // namespace pbnbrdf::cli
