// problem_fields.h: the fields of a FitProblem by name: flags, help, checks and records (base/fields.h).
#pragma once

#include "base/fields.h"
#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

// Of what a problem file holds; `asked` and `channels` belong to the material and the scene.
Fields NetworkFields(NetworkOptions* network);
Fields TermFields(TermOptions* terms);
Fields SamplingFields(SamplingOptions* sampling);

// Of a fit to a material as a scene shows it, besides the others.
Fields SceneFields(SamplingOptions* sampling);

}  // namespace pbnbrdf
