// analytic_residual.h: the log residual (eq. 6) of an analytic model at one sample, for Ceres.
#pragma once

#include <ceres/cost_function.h>

#include <memory>

#include "models/free_parameters.h"
#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// One parameter block, the numbers of `parameters`, which must outlive the function; 3 residuals,
// log1p(f_c cos_i) - log1p(f^_c cos_i), and derivatives by jets.
std::unique_ptr<ceres::CostFunction> MakeAnalyticResidual(const AnalyticModel& model, int lobes,
                                                          const FreeParameters& parameters,
                                                          const BrdfSample& sample);

}  // namespace pbnbrdf
