// scene_plan.h: which fit each material of a scene gets.
#pragma once

#include <optional>
#include <string>

#include "material_options.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/render/demand.h"

namespace pbnbrdf::cli {

struct ScenePlan {
  std::string name;
  MaterialOptions material;
  double share = 0.0, sensitivity = 0.0;  // MaterialDemand's
  bool needed = false;
  std::optional<SkipReason> skip_reason;  // none: the material is fitted
  std::string why;                        // it is fitted or not, a sentence
  FitProblem problem;
};

// problem: what the flags ask for. A material that hardly changes the image gets a small network and few
// samples, unless the flags ask for even fewer.
ScenePlan PlanFit(const SceneMaterial& material, const MaterialDemand& demand,
                  const FitProblem& problem);

}  // namespace pbnbrdf::cli
