// fit_fields.h: the fields of a problem and of the options that solve it, by name: what flags, --help,
// checks, records and problem files are made of (base/fields.h).
#pragma once

#include "base/fields.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {

// Those that say how a fit proceeds. Threads, given weights and callbacks aren't among them.
Fields OptionFields(FitOptions* options);

// With those of the problem: all that it takes to repeat a fit to a material.
Fields FitFields(FitProblem* problem, FitOptions* options);

}  // namespace pbnbrdf
