#include "pbnbrdf/solve/problem_file.h"

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "solve/fit_fields.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxFileSize = 1 << 20;  // bytes; a problem has a few dozen lines

}  // namespace

FitSetup ReadProblem(const std::string& path) {
  FitSetup setup;
  const std::string lines = ReadFile(path, kMaxFileSize);
  try {
    FitFields(&setup.problem, &setup.options).ReadLines(lines);
    ValidateFit(setup.problem, setup.options);
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
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
