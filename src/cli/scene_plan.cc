#include "scene_plan.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace pbnbrdf::cli {
namespace {

// An error of log(1 + f cos) changes the image by less than a hundredth of itself: an error ten times as
// large as elsewhere shows less. Such a material gets a tenth of the samples and weights.
constexpr double kMinSensitivity = 0.01;
constexpr std::uint64_t kFewSamples = 6000;
const std::vector<int> kSmallNetwork = {8, 8};

// "35 %", "0.012 %"
std::string Percent(double part) {
  std::ostringstream text;
  text << std::setprecision(2) << 100.0 * part << " %";
  return text.str();
}

void MakeSmall(FitProblem* problem) {
  FitProblem small = *problem;
  small.network.hidden = kSmallNetwork;
  if (small.Shape().num_weights() < problem->Shape().num_weights()) *problem = small;
  problem->sampling.samples = std::min(problem->sampling.samples, kFewSamples);
}

}  // namespace

ScenePlan PlanFit(const SceneMaterial& material, const MaterialDemand& demand,
                  const FitProblem& problem) {
  ScenePlan plan;
  plan.name = material.name;
  plan.material = {material.source, material.scale_to_albedo};
  plan.share = demand.share;
  plan.sensitivity = demand.sensitivity;
  plan.needed = demand.reached;
  plan.problem = problem;
  if (!demand.reached) {
    plan.skip_reason = demand.referenced ? SkipReason::kNotReached : SkipReason::kUnreferenced;
    plan.why = demand.referenced ? "no path hits it" : "no shape has it";
    return plan;
  }
  plan.problem.sampling.asked = demand.angles;
  plan.why = StrCat("it reflects ", Percent(demand.share), " of the image's light");
  if (demand.sensitivity < kMinSensitivity) {
    MakeSmall(&plan.problem);
    plan.why += " and hardly changes it: a small network and few samples";
  }
  return plan;
}

}  // namespace pbnbrdf::cli
