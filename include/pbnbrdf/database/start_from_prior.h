// start_from_prior.h: fits that know a database.
#pragma once

#include "pbnbrdf/network/weight_family.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// What the material is expected to be, given the measurements that a fit sees (or samples, if it isn't a list of
// them): that of FitCode. Throws Error if the material is anisotropic and the database's aren't.
NeuralBrdf Expected(const WeightFamily& family, const Brdf& material);
MerlBrdf Expected(const TablePca& pca, const Brdf& material);

// Lets a fit know it: `expected` of the options. Of a family the fit also starts there, if it has the same shape of
// network (`initial_weights`), and has its encoding, where the problem leaves it open.
void StartFromPrior(const WeightFamily& family, const Brdf& material, FitProblem* problem,
                    FitOptions* options);
void StartFromPrior(const TablePca& pca, const Brdf& material, FitProblem* problem,
                    FitOptions* options);

}  // namespace pbnbrdf
