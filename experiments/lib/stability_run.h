// stability_run.h: runs one case of the stability sweep and checks the result.
#pragma once

#include "stability_case.h"
#include "stability_record.h"

namespace pbnbrdf {

// Fits, evaluates the network where it is hardest to evaluate, measures it and checks its gradient.
// An Error becomes an outcome; any other exception is passed on.
StabilityRecord RunStabilityCase(const StabilityCase& to_run);

}  // namespace pbnbrdf
