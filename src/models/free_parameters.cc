#include "models/free_parameters.h"

#include <algorithm>

namespace pbnbrdf {

FreeParameters::FreeParameters(const AnalyticModel& model, int lobes, bool isotropic) {
  for (const PlacedParameter& placed : PlacedParameters(model, lobes)) {
    const ModelParameter& parameter = *placed.parameter;
    Rule rule = parameter.logarithmic ? Rule::kLogarithmic : Rule::kLinear;
    if (isotropic && parameter.when_isotropic == WhenIsotropic::kAsPrevious) {
      rule = Rule::kAsPrevious;
    } else if (isotropic && parameter.when_isotropic == WhenIsotropic::kZero) {
      rule = Rule::kZero;
    }
    for (int c = 0; c < parameter.size; ++c) {
      rules_.push_back(rule);
      scalar_lower_.push_back(parameter.lower);
      scalar_upper_.push_back(parameter.upper);
    }
  }
  lower_ = FromScalars(scalar_lower_);
  upper_ = FromScalars(scalar_upper_);
}

std::vector<double> FreeParameters::ToBoundedScalars(const std::vector<double>& numbers) const {
  std::vector<double> scalars(num_scalars());
  ToScalars(numbers.data(), scalars.data());
  for (std::size_t i = 0; i < scalars.size(); ++i) {
    scalars[i] = std::clamp(scalars[i], scalar_lower_[i], scalar_upper_[i]);
  }
  return scalars;
}

std::vector<double> FreeParameters::FromScalars(const std::vector<double>& scalars) const {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    if (rules_[i] == Rule::kLinear) numbers.push_back(scalars[i]);
    if (rules_[i] == Rule::kLogarithmic) numbers.push_back(std::log(scalars[i]));
  }
  return numbers;
}

}  // namespace pbnbrdf
