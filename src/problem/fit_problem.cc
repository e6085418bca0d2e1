#include "pbnbrdf/problem/fit_problem.h"

#include <algorithm>
#include <cmath>

#include "pbnbrdf/base/error.h"
#include "problem/problem_fields.h"
#include "problem/robust_loss.h"
#include "problem/terms.h"

namespace pbnbrdf {

NetworkOptions NetworkOptions::Of(const NetworkShape& shape) {
  NetworkOptions options;
  options.encoding = shape.encoding();
  options.hidden = shape.hidden();
  options.activation = shape.activation();
  options.channels = shape.num_outputs();
  return options;
}

NetworkShape NetworkOptions::Shape() const {
  return NetworkShape(encoding.value_or(Encoding::kMerl), hidden, activation,
                      channels == 0 ? NetworkShape::kChannels : channels);
}

double TermOptions::Weight(std::string_view name) const {
  for (const WeightedTerm& term : weights) {
    if (term.name == name) return term.weight;
  }
  return 0.0;
}

void TermOptions::SetWeight(std::string_view name, double weight) {
  const auto found = std::find_if(weights.begin(), weights.end(),
                                  [&](const WeightedTerm& term) { return term.name == name; });
  if (weight == 0.0) {
    if (found != weights.end()) weights.erase(found);
  } else if (found != weights.end()) {
    found->weight = weight;
  } else {
    weights.push_back({std::string(name), weight});
  }
}

SampleAngles SamplingOptions::Angles() const {
  SampleAngles all = angles;
  if (!asked) return all;
  all.asked = asked;
  all.floor = asked_floor;
  return all;
}

FitProblem FitProblem::For(const Brdf& material) const {
  FitProblem settled = *this;
  if (!settled.network.encoding) settled.network.encoding = EncodingFor(material);
  if (settled.network.channels == 0) settled.network.channels = material.NumChannels();
  return settled;
}

void FitProblem::Validate() const {
  FitProblem copy = *this;
  NetworkFields(&copy.network).Check();
  TermFields(&copy.terms).Check();
  SamplingFields(&copy.sampling).Check();
  SceneFields(&copy.sampling).Check();
  Shape();
  bool has_sample_term = false;
  for (const WeightedTerm& term : terms.weights) {
    const TermType& type = *FindTermType(term.name);
    has_sample_term |= type.make != nullptr;
    if (type.needs_color && network.channels == 1) {
      Fail("terms: ", term.name, " is of no use to a single channel");
    }
  }
  if (!has_sample_term) Fail("terms: log or chromaticity must be among them, with a weight > 0");
}

std::unique_ptr<ceres::LossFunction> MakeLoss(const TermOptions& terms) {
  if (terms.loss != Loss::kSoftL1) return nullptr;
  return std::make_unique<ceres::SoftLOneLoss>(terms.loss_scale);
}

}  // namespace pbnbrdf
