// fit_model.h: pbnbrdf fit --model: an analytic model instead of a network.
#pragma once

#include "command_line.h"

namespace pbnbrdf::cli {

// --model and what comes with it.
FlagGroup ModelFlags();

// Whether --model is given. Throws UsageError if flags that only it has are given without it.
bool FitsModel();

// Fits the model to the material and writes the JSON file --out. Throws Error, and UsageError if
// flags are given that only networks have.
int RunModelFit();

}  // namespace pbnbrdf::cli
