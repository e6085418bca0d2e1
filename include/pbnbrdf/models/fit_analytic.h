// fit_analytic.h: fits an analytic model to samples of a material, the comparison of Ngan et al. [1].
//
//   const auto material = pbnbrdf::OpenBrdf("gold.binary");
//   const auto samples = pbnbrdf::DrawSamples(*material, ...);
//   const auto fit = pbnbrdf::FitAnalytic(samples, /*isotropic=*/true, pbnbrdf::FindAnalyticModel("ggx"), {});
//   std::cout << fit.brdf.Text();
//
// Minimises, over the parameters of the model's base and of its lobes within their bounds
// (brdf/model_parameter.h),
//
//   1/2 sum over samples of rho(|r|^2),   r_c = log(1 + f_c cos_i) - log(1 + f^_c cos_i),
//
// the log residual (eq. 6) with rho the smooth L1 norm, by Ceres' Levenberg-Marquardt on jets
// through the formulas.
//
// [1] A. Ngan, F. Durand, W. Matusik. Experimental Analysis of BRDF Models. EGSR 2005.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {

struct AnalyticFitOptions {
  int lobes = 1;                       // 1 to kMaxLobes; models without lobes don't ask
  double loss_scale = 0.001;           // > 0, |r| at which rho turns from square to linear
  std::uint64_t first_samples = 1000;  // >= 1, that the starts see: the first of all
  int starts = 12;                     // >= 1: from narrow lobes to wide ones; the best ones go on
  int max_iterations = 100;            // >= 1, of the last stage
  double function_tolerance = 1e-5;    // stop when |cost change| < function_tolerance * cost
  double lobe_gain = 0.0;  // a second lobe that lowers the cost by a smaller part is left out
  int threads = 0;         // 0: as many as the machine has

  // Throws Error, naming the field, its value and what it must be.
  void Validate() const;
};

struct AnalyticFitSummary {
  double final_cost = 0.0;  // per sample
  int iterations = 0;       // of the stages that led to the fit
  bool converged = false;   // else max_iterations or the solver ended it
  double seconds = 0.0;
  std::string message;  // the solver's own words
};

struct AnalyticFit {
  AnalyticBrdf brdf;
  AnalyticFitSummary summary;
};

// samples: at least one. An isotropic material gets an isotropic model, an anisotropic one a model whose axes are those of
// the shading frame. Two lobes fit no worse than one: a fit of one is among their starts. The same
// arguments give the same parameters to the last bit, whatever the number of threads. Throws Error
// as Validate does, and if no start has a finite cost.
AnalyticFit FitAnalytic(std::span<const BrdfSample> samples, bool isotropic,
                        const AnalyticModel& model, const AnalyticFitOptions& options);

}  // namespace pbnbrdf
