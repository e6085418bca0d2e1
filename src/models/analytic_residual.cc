#include "models/analytic_residual.h"

#include <ceres/dynamic_autodiff_cost_function.h>

#include <algorithm>
#include <utility>

#include "models/analytic_formulas.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr int kStride = 12;  // derivatives at a time
constexpr std::size_t kMaxScalars = 24;

template <typename Formula>
class AnalyticResidual {
 public:
  static_assert(SizeOf(Formula::kBase) + kMaxLobes * SizeOf(Formula::kLobe) <= kMaxScalars);

  AnalyticResidual(int lobes, const FreeParameters& parameters, const BrdfSample& sample)
      : lobes_(lobes), parameters_(parameters), geometry_(sample.pair), cos_i_(CosI(sample.pair)) {
    for (int c = 0; c < 3; ++c) target_[c] = std::log1p(sample.value[c] * cos_i_);
  }

  // False if a residual isn't finite.
  template <typename T>
  bool operator()(T const* const* numbers, T* residuals) const {
    using std::isfinite, std::log1p;
    std::array<T, kMaxScalars> scalars;
    parameters_.ToScalars(numbers[0], scalars.data());
    const std::array<T, 3> f = EvaluateFormula<Formula>(geometry_, scalars.data(), lobes_);
    for (int c = 0; c < 3; ++c) {
      residuals[c] = target_[c] - log1p(f[c] * cos_i_);
      if (!isfinite(residuals[c])) return false;
    }
    return true;
  }

 private:
  int lobes_;
  const FreeParameters& parameters_;
  ReflectionGeometry geometry_;
  double cos_i_;
  Rgb target_;
};

using Result = std::unique_ptr<ceres::CostFunction>;

template <typename Formula>
Result MakeOf(int lobes, const FreeParameters& parameters, const BrdfSample& sample) {
  using Functor = AnalyticResidual<Formula>;
  auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<Functor, kStride>>(
      new Functor(lobes, parameters, sample));
  cost->AddParameterBlock(static_cast<int>(parameters.size()));
  cost->SetNumResiduals(3);
  return cost;
}

// That of the formula which has the model's name.
template <std::size_t... I>
Result MakeByName(std::string_view name, std::index_sequence<I...>, int lobes,
                  const FreeParameters& parameters, const BrdfSample& sample) {
  Result result;
  const auto try_formula = [&]<typename Formula>(const Formula*) {
    if (Formula::kName == name) result = MakeOf<Formula>(lobes, parameters, sample);
  };
  (try_formula(static_cast<std::tuple_element_t<I, AnalyticFormulas>*>(nullptr)), ...);
  if (!result) Fail("model '", name, "' has no formula");
  return result;
}

}  // namespace

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

std::unique_ptr<ceres::CostFunction> MakeAnalyticResidual(const AnalyticModel& model, int lobes,
                                                          const FreeParameters& parameters,
                                                          const BrdfSample& sample) {
  return MakeByName(model.name, std::make_index_sequence<std::tuple_size_v<AnalyticFormulas>>(),
                    lobes, parameters, sample);
}

}  // namespace pbnbrdf
