// fit.h: fits a neural BRDF to a material: the library's main entry.
//
//   const auto material = pbnbrdf::OpenBrdf("gold.binary");
//   const pbnbrdf::Fit fit = pbnbrdf::FitBrdf(*material, pbnbrdf::FitProblem{}, {});
//   fit.network.Write("gold.safetensors");
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

struct FitProgress {
  int iteration = 0;
  double cost = 0.0;           // fit_problem.h
  double heldout_error = 0.0;  // mean |eq. 6| over held-out samples and channels
  double seconds = 0.0;        // since the start, without evaluating heldout_error
};

// When a fit takes more samples, and when it ends.
struct ScheduleOptions {
  // A fit starts on the first few samples and takes `growth` times as many each time that the cost falls
  // slowly, up to all. Adam has all from the start.
  std::uint64_t first_samples = 1000;
  double growth = 3.0;  // > 1
  // lm fits a network of more weights than this as a narrower one first, and gives it `growth` times as many each
  // time that neither samples nor iterations help, up to all; >= 1.
  std::uint64_t first_weights = 1000;
  // Short runs from different random weights, of which the best one goes on; >= 1, Adam: 1.
  int starts = 1;
  // lm sums J'J over about so many of the samples, others each time (linearization.h); >= 1.
  std::uint64_t curvature_samples = 4096;
  // >= 0, of each width without the energy term, and again with it; Adam: epochs
  int max_iterations = 400;
  double max_seconds = 3600.0;  // > 0
  // Stop when all samples are in and 25 iterations take less than this part off the error of samples that
  // no solver sees, or of 1e-4 where that is larger; [0, 1]. Not for Adam.
  double error_tolerance = 0.005;
  double function_tolerance = 1e-6;  // stop when |cost change| < function_tolerance * cost, which
                                     // with Adam is that of a mean (adam.cc)
};

// Adam's options. The defaults are NBRDF's settings (Sztrajman et al. 2021).
struct AdamOptions {
  std::uint64_t batch = 512;    // samples a step, >= 1; an epoch's last, smaller batch is left out
  double learning_rate = 5e-4;  // > 0
  int energy_angles = 2;        // incident angles a step of the energy term, 1 to 1024
};

struct FitOptions {
  // By name:
  //   lm           Levenberg-Marquardt on the normal equations (lm.cc); ceres_lbfgs goes on with networks of
  //                more than 2500 weights
  //   ceres_lm     Ceres' own: the same steps, at several times the cost
  //   ceres_lbfgs  Ceres' L-BFGS: cheap iterations, but thousands of them
  //   adam         on minibatches of the papers' own loss (adam.cc), the published solver
  //   autodiff     Ceres' Levenberg-Marquardt on jets through the whole network: the slow reference
  std::string solver = "lm";
  ScheduleOptions schedule;
  AdamOptions adam;
  bool acceleration = true;  // lm: geodesic acceleration of its steps (lm.cc)
  Precision precision = Precision::kSingle;
  // With the energy term: ends with no directional albedo above 1, if need be by lowering f where energy is
  // made. The published scripts don't.
  bool certify_energy = true;
  int threads = 0;  // 0: as many as the machine has
  // Where to start from: Shape().num_weights() numbers of the problem, or none for random ones.
  std::vector<double> initial_weights;
  // What a material that is a list of measurements is expected to be between them (SampleStream), such as what
  // a database says of it (database/start_from_prior.h); null: an analytic model that is fitted to them.
  std::shared_ptr<const Brdf> expected;
  // Called after each iteration if set; false stops the fit with the best weights so far.
  std::function<bool(const FitProgress&)> on_iteration;
  // Whether on_iteration is told the held-out error, which takes time; else it is told 0.
  bool reports_heldout_error = true;
  // Whether max_seconds limits that time, too, and that of on_iteration; FitSummary::seconds never counts it.
  bool limits_wall_time = false;
};

enum class Termination {
  kConverged,
  kMaxIterations,
  kMaxSeconds,
  kInterrupted,
  // The cost or its derivatives aren't finite any more, or no step can be computed. The weights are
  // the best ones before.
  kDiverged,
};

inline constexpr NameTable<Termination, 5> kTerminations = {
    {{"converged", Termination::kConverged},
     {"max_iterations", Termination::kMaxIterations},
     {"max_seconds", Termination::kMaxSeconds},
     {"interrupted", Termination::kInterrupted},
     {"diverged", Termination::kDiverged}}};

// What the energy term did, and how the fit came to conserve energy.
struct EnergySummary {
  double first_max_albedo = 0.0;  // largest directional albedo of the fit without the term
  double max_albedo = 0.0;        // the same in the end, by the fit's own check
  int rounds = 0;                 // stages with the term; 0: it wasn't needed
  std::size_t strata = 0;         // of incident directions, in the last of them
  double correction = 0.0;        // mean change of log(1 + f) by the final correction
  // The network's albedos in the end, as MeasureEnergy has them; none if they weren't checked so closely.
  std::vector<IncidentAlbedo> profile;
  EnergyWork work;
};

// How far a fit was, and when.
struct FitMoment {
  int iteration = 0;
  double seconds = 0.0;  // as FitSummary::seconds
  double error = 0.0;  // mean |eq. 6| over samples drawn as those of the fit, which no solver sees
};

struct FitSummary {
  double final_cost = 0.0;  // fit_problem.h
  int iterations = 0;       // of all stages
  int restarts = 0;  // random weights drawn anew, as the cost wasn't finite or the network was dead
  // Iterations of Levenberg-Marquardt for which no step could be computed, and whose step was too poor to
  // take; of all stages.
  int failed_factorizations = 0;
  int rejected_steps = 0;
  std::size_t samples = 0;         // that the fit used in the end
  EnergySummary energy;            // of a fit with the energy term
  std::vector<FitMoment> history;  // of the start of each stage, and of each iteration
  // Of single precision only: rounding changes the final cost by more than a hundredth, so that
  // double precision would have gone further.
  bool precision_limited = false;
  double seconds = 0.0;  // with sampling the material, without reading it or evaluating errors
  Termination termination = Termination::kConverged;
  std::string message;  // the solver's own words
};

struct Fit {
  NeuralBrdf network;
  FitProblem problem;  // that was solved: with the encoding and the channels that suit the material
  FitSummary summary;
};

// What FitBrdf checks before it starts. Throws Error if the problem or the options are invalid or
// don't go together.
void ValidateFit(const FitProblem& problem, const FitOptions& options);

// The same arguments give the same network to the last bit, whatever the number of threads. The energy
// term joins in a second stage, if the directional albedo of the first stage's network exceeds 1 in a
// stratum; Adam, as published, has it and all samples from the start. An anisotropic material takes any
// encoding, an isotropic one gives the best isotropic fit. A solver that diverges ends the fit with the
// best network so far (Termination::kDiverged). Throws Error as ValidateFit does, if the encoding is
// anisotropic and the material isn't, if the material has next to no data, and where there is no
// start: at the given weights, or at each of several random ones, the cost or a derivative isn't
// finite, or the gradient is 0 and the cost isn't; or the given network is constant and would stay
// so, the material not being constant.
Fit FitBrdf(const Brdf& material, const FitProblem& problem, const FitOptions& options);

}  // namespace pbnbrdf
