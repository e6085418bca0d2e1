// code_minimizer.h: the least cost of a material over its code alone, the rest of a family being given.
#pragma once

#include <vector>

#include "pbnbrdf/network/weight_family.h"
#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

struct CodeMinimum {
  std::vector<double> code;
  double cost = 0.0;  // with the ridge
};

// Minimises the objective's cost plus ridge / 2 * |code|^2 by Levenberg-Marquardt, from `code` on, which is kept where
// nothing better is found.
CodeMinimum MinimizeOverCode(const WeightFamily& family, double ridge, std::vector<double> code,
                             Objective* objective);

}  // namespace pbnbrdf
