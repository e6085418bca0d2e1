#include "models/analytic_residual.h"

#include <ceres/dynamic_autodiff_cost_function.h>

#include <utility>

#include "models/analytic_formulas.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr int kStride = 12;  // derivatives at a time
constexpr std::size_t kMostScalars = 24;

template <typename Formula>
class AnalyticResidual {
 public:
  static_assert(SizeOf(Formula::kBase) + kMostLobes * SizeOf(Formula::kLobe) <= kMostScalars);

  AnalyticResidual(int lobes, const FreeParameters& parameters, const BrdfSample& sample)
      : lobes_(lobes), parameters_(parameters), geometry_(sample.pair), cos_i_(CosI(sample.pair)) {
    for (int c = 0; c < 3; ++c) target_[c] = std::log1p(sample.value[c] * cos_i_);
  }

  // False if a residual isn't finite.
  template <typename T>
  bool operator()(T const* const* numbers, T* residuals) const {
    using std::isfinite, std::log1p;
    std::array<T, kMostScalars> scalars;
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

std::unique_ptr<ceres::CostFunction> MakeAnalyticResidual(const AnalyticModel& model, int lobes,
                                                          const FreeParameters& parameters,
                                                          const BrdfSample& sample) {
  return MakeByName(model.name, std::make_index_sequence<std::tuple_size_v<AnalyticFormulas>>(),
                    lobes, parameters, sample);
}

}  // namespace pbnbrdf
