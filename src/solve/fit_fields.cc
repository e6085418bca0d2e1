#include "solve/fit_fields.h"

#include "base/about.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/solve/problem_file.h"
#include "problem/problem_fields.h"
#include "solve/solver.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxFileSize = 1 << 20;  // bytes; a problem has a few dozen lines

std::string SolversHelp() {
  std::string text;
  for (const Solver& solver : Solvers()) {
    text += StrCat(text.empty() ? "" : " | ", solver.name, " (", solver.help, ")");
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
  fields.Add(Choice("precision", &options->precision, kPrecisions,
                    "floating-point precision of the network"));
  fields.Add(
      Switch("acceleration", &options->acceleration,
             "lm: bend each step by the second derivatives of the residuals along it (geodesic "
             "acceleration)"));
  fields.Add(Integer("first_samples", &schedule->first_samples, AtLeast(1),
                     "training samples to start with; --samples or more: all of them"));
  fields.Add(
      Number("growth", &schedule->growth, Above(1.0),
             "factor by which the training samples grow each time that the cost falls slowly"));
  fields.Add(
      Integer("first_weights", &schedule->first_weights, AtLeast(1),
              "lm: a network of more weights than this starts as a narrower one, which grows"));
  fields.Add(Integer("starts", &schedule->starts, AtLeast(1),
                     "number of random initial weights to try; the fit goes on with the best"));
  fields.Add(Integer("curvature_samples", &schedule->curvature_samples, AtLeast(1),
                     "lm: samples that J'J is summed over; each iteration takes others"));
  fields.AddCommon(Integer(
      "max_iterations", &schedule->max_iterations, AtLeast(0),
      "maximum number of iterations (adam: epochs), and as many again with the energy term"));
  fields.AddCommon(Number("max_seconds", &schedule->max_seconds, Above(0.0),
                          "maximum time for the fit, seconds"));
  fields.Add(Number(
      "error_tolerance", &schedule->error_tolerance, Between(0.0, 1.0),
      "stop when 25 iterations lower the error of unseen samples by a smaller part than this; "
      "errors below 1e-4 count as 1e-4"));
  fields.Add(Number("function_tolerance", &schedule->function_tolerance, AtLeast(0.0),
                    "stop when an iteration lowers the cost by a smaller part than this"));
  fields.Add(Switch("certify_energy", &options->certify_energy,
                    "with the energy term: make sure that no directional albedo is above 1, if "
                    "need be by lowering f where energy is made"));
  fields.Add(Integer("batch", &options->adam.batch, AtLeast(1), "adam: samples in a step"));
  fields.Add(Number("learning_rate", &options->adam.learning_rate, Above(0.0), "adam: step size"));
  fields.Add(Integer("energy_angles", &options->adam.energy_angles, Between(1, 1024),
                     "adam: random incident angles of the energy term in a step"));
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

FitSetup ReadProblem(const std::string& path) {
  FitSetup setup;
  const std::string lines = ReadFile(path, kMaxFileSize);
  About(path, [&] {
    FitFields(&setup.problem, &setup.options).ReadLines(lines);
    ValidateFit(setup.problem, setup.options);
  });
  return setup;
}

std::string ProblemText(const FitSetup& setup) {
  FitSetup copy = setup;
  return FitFields(&copy.problem, &copy.options).Lines();
}

void WriteProblem(const std::string& path, const FitSetup& setup) {
  WriteFile(path, ProblemText(setup));
}

}  // namespace pbnbrdf
