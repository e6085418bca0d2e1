// chromaticity_term.h: the chromaticity term (eq. 7), vectorised for Adam.
#pragma once

#include "kernels/losses.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"
#include "problem/jet_term.h"

namespace pbnbrdf {

class ChromaticityTerm final : public JetTerm<ChromaticityResidual> {
 public:
  void AddAbsoluteGradient(const float* z, const float* cos_i, const float* f, float scale,
                           float* gradient) const override {
    kernels::AddAbsoluteChromaticityGradient(z, cos_i, f, scale, gradient);
  }
};

}  // namespace pbnbrdf
