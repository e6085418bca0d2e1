// log_term.h: the log term (eq. 6), vectorised.
#pragma once

#include "pbnbrdf/residuals/log_residual.h"
#include "problem/jet_term.h"

namespace pbnbrdf {

// LogResidual and its derivative, a batch at a time.
class LogTerm final : public JetTerm<LogResidual> {
 public:
  void Grow(const EncodedSamples& samples, std::size_t count) override;
  void Evaluate(std::size_t b, int size, const double* z, TermBatch* to) const override;
  void EvaluateResiduals(std::size_t b, int size, const double* z, TermBatch* to) const override;
  void AddAbsoluteGradient(const float* z, const float* cos_i, const float* f, float scale,
                           float* gradient) const override;

 private:
  std::size_t count_ = 0;          // of samples
  AlignedVector<double> cos_i_;    // batch after batch
  AlignedVector<double> targets_;  // log1p(f cos_i), batch after batch, each by feature
};

}  // namespace pbnbrdf
