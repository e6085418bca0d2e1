#include "problem/fit_target.h"

#include "pbnbrdf/brdf/reciprocal.h"

namespace pbnbrdf {

std::shared_ptr<const Brdf> FitTarget(const Brdf& material, Encoding encoding) {
  const auto estimate =
      IsReciprocal(encoding) ? Brdf::Estimate::kLikeliest : Brdf::Estimate::kAsStored;
  std::shared_ptr<const Brdf> target = material.BestEstimate(estimate);
  if (!target) target = std::shared_ptr<const Brdf>(std::shared_ptr<void>(), &material);
  if (!IsReciprocal(encoding) || target->IsReciprocal()) return target;
  return std::make_shared<ReciprocalBrdf>(std::move(target));
}

}  // namespace pbnbrdf
