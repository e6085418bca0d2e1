#include "pbnbrdf/brdf/reciprocal.h"

#include <algorithm>
#include <utility>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Of a direction that isn't known beside one that is.
constexpr double kMinWeight = 1e-9;

}  // namespace

ReciprocalBrdf::ReciprocalBrdf(std::shared_ptr<const Brdf> source) : source_(std::move(source)) {}

double ReciprocalBrdf::Weight(const DirectionPair& pair) const {
  return source_->IsKnown(pair) ? source_->Certainty(pair) : kMinWeight;
}

void ReciprocalBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                       std::span<Rgb> values) const {
  std::vector<DirectionPair> swapped(pairs.size());
  std::transform(pairs.begin(), pairs.end(), swapped.begin(), Swapped);
  std::vector<Rgb> there(pairs.size()), back(pairs.size());
  source_->EvaluateUnclipped(pairs, there);
  source_->EvaluateUnclipped(swapped, back);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const double a = Weight(pairs[n]), b = Weight(swapped[n]);
    for (int c = 0; c < 3; ++c) values[n][c] = (a * there[n][c] + b * back[n][c]) / (a + b);
  }
}

bool ReciprocalBrdf::IsKnown(const DirectionPair& pair) const {
  return source_->IsKnown(pair) || source_->IsKnown(Swapped(pair));
}

std::unique_ptr<Brdf> ReciprocalBrdf::BestEstimate(Estimate estimate) const {
  std::unique_ptr<Brdf> best = source_->BestEstimate(estimate);
  return best ? std::make_unique<ReciprocalBrdf>(std::move(best)) : nullptr;
}

double ReciprocalBrdf::Certainty(const DirectionPair& pair) const {
  return std::max(Weight(pair), Weight(Swapped(pair)));
}

std::string ReciprocalBrdf::Description() const {
  return StrCat(source_->Description(), ", both orders of a pair averaged");
}

}  // namespace pbnbrdf
