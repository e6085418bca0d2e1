#include "problems.h"

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

std::string ShippedProblemFile(const std::string& name) {
  return StrCat(PBNBRDF_PROBLEMS "/", name, ".flags");
}

FitSetup ShippedProblem(const std::string& name) { return ReadProblem(ShippedProblemFile(name)); }

}  // namespace pbnbrdf
