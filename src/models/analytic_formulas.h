// analytic_formulas.h: the list of all formulas, for whoever instantiates them.
#pragma once

#include <tuple>

#include "models/facets.h"
#include "models/lobes.h"
#include "models/principled.h"

namespace pbnbrdf {

using AnalyticFormulas =
    std::tuple<LambertFormula, OrenNayarFormula, PhongFormula, BlinnPhongFormula, LafortuneFormula,
               WardFormula<WardVariant::kOriginal>, WardFormula<WardVariant::kDuer>,
               WardFormula<WardVariant::kBounded>, CookTorranceFormula, GgxFormula, AbcFormula,
               DisneyFormula, PrincipledFormula>;

// f of the formula with `lobes` lobes, 1/sr; double parameters or Ceres' jets.
template <typename Formula, typename T>
std::array<T, 3> EvaluateFormula(const ReflectionGeometry& geometry, const T* parameters,
                                 int lobes) {
  std::array<T, 3> f = {T(0.0), T(0.0), T(0.0)};
  Formula::AddBase(geometry, parameters, f.data());
  for (int lobe = 0; lobe < lobes; ++lobe) {
    Formula::AddLobe(geometry, parameters + SizeOf(Formula::kBase) + lobe * SizeOf(Formula::kLobe),
                     f.data());
  }
  return f;
}

}  // namespace pbnbrdf
