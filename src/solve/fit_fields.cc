#include "solve/fit_fields.h"

#include "pbnbrdf/base/error.h"
#include "problem/problem_fields.h"
#include "solve/solver.h"

namespace pbnbrdf {
namespace {

std::string SolversHelp() {
  std::string text;
  for (const Solver& solver : Solvers()) {
    text += StrCat(text.empty() ? "" : "; ", solver.name, ", ", solver.help);
  }
  return text;
}

}  // namespace

Fields OptionFields(FitOptions* options) {
  ScheduleOptions* schedule = &options->schedule;
  Fields fields;
  fields.Group("The solver");
  fields.AddCommon(Custom(
      "solver", [options](std::string_view text) { options->solver = FindSolver(text).name; },
      [options] { return options->solver; }, [options] { FindSolver(options->solver); },
      SolversHelp()));
  fields.Add(Choice("precision", &options->precision, kPrecisions, "of the network's passes"));
  fields.Add(Integer("first_samples", &schedule->first_samples, AtLeast(1),
                     "training samples to start with"));
  fields.Add(Number("growth", &schedule->growth, Above(1.0),
                    "factor of training samples each time that the cost falls slowly"));
  fields.Add(Integer("starts", &schedule->starts, AtLeast(1),
                     "try so many random weights and go on with the best"));
  fields.Add(Integer("curvature_samples", &schedule->curvature_samples, AtLeast(1),
                     "lm: samples that J'J is summed over, others each time"));
  fields.AddCommon(Integer("max_iterations", &schedule->max_iterations, AtLeast(0),
                           "iterations (adam: epochs), and as many again with the energy term"));
  fields.AddCommon(Number("max_seconds", &schedule->max_seconds, Above(0.0), "time for the fit"));
  fields.Add(Number("function_tolerance", &schedule->function_tolerance, AtLeast(0.0),
                    "a stage ends when an iteration lowers the cost by a smaller part"));
  fields.Add(
      Switch("certify_energy", &options->certify_energy,
             "end with no directional albedo above 1, lowering the whole network if need be"));
  fields.Add(Integer("batch", &options->adam.batch, AtLeast(1), "adam: samples a step"));
  fields.Add(Number("learning_rate", &options->adam.learning_rate, Above(0.0), "adam: step size"));
  fields.Add(Integer("energy_angles", &options->adam.energy_angles, Between(1, 1024),
                     "adam: random incident angles a step of the energy term"));
  return fields;
}

Fields FitFields(FitProblem* problem, FitOptions* options) {
  Fields fields;
  fields.Add(NetworkFields(&problem->network));
  fields.Add(TermFields(&problem->terms));
  fields.Add(SamplingFields(&problem->sampling));
  fields.Add(OptionFields(options));
  return fields;
}

}  // namespace pbnbrdf
