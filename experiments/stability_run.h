// stability_run.h: one fit of the stability sweep, and all that is looked at when it has ended.
#pragma once

#include "stability_case.h"
#include "stability_record.h"

namespace pbnbrdf {

// Fits, evaluates the network where it is hardest to evaluate, measures it and checks its gradient.
// An Error is an outcome; whatever else is thrown passes.
StabilityRecord RunStabilityCase(const StabilityCase& to_run);

}  // namespace pbnbrdf
