#include "problems.h"

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

FitSetup ShippedProblem(const std::string& name) {
  return ReadProblem(StrCat(PBNBRDF_PROBLEMS "/", name, ".flags"));
}

}  // namespace pbnbrdf
