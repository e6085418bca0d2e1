// sample_term.h: a term of the cost that is a mean over samples: its residuals, batch by batch, and their
// derivatives with respect to the network's outputs z.
#pragma once

#include "base/aligned_vector.h"
#include "kernels/kernels.h"
#include "pbnbrdf/network/network_shape.h"
#include "problem/encoded_samples.h"

namespace ceres {
class CostFunction;
}

namespace pbnbrdf {

// The residuals of a term at a batch of samples. By feature (kernels.h).
struct TermBatch {
  explicit TermBatch(int rows)
      : residuals(static_cast<std::size_t>(rows) * kernels::kBatch),
        slopes(residuals.size() * NetworkShape::kChannels) {}

  AlignedVector<double> residuals;  // (row), rows x kBatch
  AlignedVector<double> slopes;     // (row, c): d residual / d z_c, rows x kChannels x kBatch
};

inline double Sign(double x) { return (x > 0.0) - (x < 0.0); }

class SampleTerm {
 public:
  static constexpr int kChannels = NetworkShape::kChannels;
  static constexpr int kBatch = kernels::kBatch;

  virtual ~SampleTerm() = default;

  // Residuals of a sample.
  virtual int rows() const = 0;

  // Takes the samples up to the count-th; the first of them it has already.
  virtual void Grow(const EncodedSamples& samples, std::size_t count) = 0;

  // At batch b, which holds `size` samples; z: by feature, kChannels x kBatch. What stands behind the
  // last sample is unspecified. `to` is one of this term's own: slopes that are always 0 stay so.
  virtual void Evaluate(std::size_t b, int size, const double* z, TermBatch* to) const = 0;

  // The residuals alone.
  virtual void EvaluateResiduals(std::size_t b, int size, const double* z, TermBatch* to) const = 0;

  // Adds to gradient, for each of kBatch samples of f at cos_i, scale times that of the mean over rows of
  // |residual| with respect to z; 0 where cos_i = 0. By feature: z, f and gradient kChannels x kBatch.
  virtual void AddAbsoluteGradient(const float* z, const float* cos_i, const float* f, float scale,
                                   float* gradient) const = 0;

  // The term at a sample as a function of the weights, by jets through the whole network.
  virtual ceres::CostFunction* NewCostFunction(const NetworkShape& shape,
                                               const BrdfSample& sample) const = 0;
};

}  // namespace pbnbrdf
