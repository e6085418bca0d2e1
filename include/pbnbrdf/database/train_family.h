// train_family.h: one network for all materials of a database, and a code for each.
//
//   const auto trained = pbnbrdf::TrainFamily(materials, pbnbrdf::FamilyProblem(), {});
//   trained.family.Write("merl.prior");
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "pbnbrdf/database/database_material.h"
#include "pbnbrdf/network/weight_family.h"
#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

struct FamilyProgress {
  int iteration = 0;
  double cost = 0.0;     // the mean of the materials' (fit_problem.h)
  double seconds = 0.0;  // since the start
};

struct FamilyOptions {
  int code_size = 16;           // 1 to WeightFamily::kMaxCodeSize, fewer than there are materials
  int max_iterations = 200;     // >= 0
  double max_seconds = 3600.0;  // > 0, without the energy of the materials
  int threads = 0;              // 0: as many as the machine has
  // Called after each iteration if set; false ends the training with what there is.
  std::function<bool(const FamilyProgress&)> on_iteration;
};

struct TrainedFamily {
  WeightFamily family;
  double cost = 0.0;
  int iterations = 0;
  double seconds = 0.0;
  // Of each member, by the check that fits have: at most 1, unless no code was found with which it is.
  std::vector<double> max_albedos;
};

// The defaults of a fit, but for a few thousand samples of each material and a loss that turns linear where a
// family's errors are.
FitProblem FamilyProblem();

// The materials' networks by Gauss and Newton: mean, basis and codes together. The codes begin as the principal
// components of log(1 + f cos theta_i). In the end each material's code is fitted once more, with the energy term where
// its directional albedo exceeds 1. The same arguments give the same family to the last bit, whatever the number of
// threads, unless the time ends it. problem: the encoding, if left open, is what suits the first material. Throws
// Error if the problem or the options are invalid, there are fewer than two materials or next to no data, or
// the cost isn't finite.
TrainedFamily TrainFamily(std::span<const DatabaseMaterial> materials, const FitProblem& problem,
                          const FamilyOptions& options);

}  // namespace pbnbrdf
