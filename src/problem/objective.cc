#include "pbnbrdf/problem/objective.h"

#include <cmath>
#include <limits>

#include "problem/energy_term.h"
#include "problem/sample_sums.h"

namespace pbnbrdf {
namespace {

bool IsFinite(const Linearization& at) {
  // A sum is finite only if all of its terms are, and J'J is if its diagonal is, as |(J'J)_ij| is
  // at most the larger one of (J'J)_ii and (J'J)_jj.
  double sum = at.cost;
  for (double value : at.gradient) sum += 0.0 * value;
  for (std::size_t i = 0; i < at.hessian.size(); i += at.gradient.size() + 1) {
    sum += 0.0 * at.hessian[i];
  }
  return std::isfinite(sum);
}

// Sums over samples, and the energy term. T: of the network's passes.
template <typename T>
class SumObjective final : public Objective {
 public:
  // owned: null, or the samples.
  SumObjective(const FitProblem& problem, const EncodedSamples& samples, std::size_t count,
               std::unique_ptr<EncodedSamples> owned)
      : owned_(std::move(owned)),
        shape_(problem.Shape()),
        sums_(shape_, problem.terms, samples),
        energy_(problem) {
    sums_.Grow(count);
    const double weight = problem.terms.EnergyWeight();
    if (weight > 0.0) energy_.Set(weight, EqualStrata(problem));
  }

  const NetworkShape& shape() const override { return shape_; }
  std::size_t num_samples() const override { return sums_.num_samples(); }
  void Grow(std::size_t count) override { sums_.Grow(count); }
  void SetEnergy(double weight, std::span<const EnergyStratum> strata) override {
    energy_.Set(weight, strata);
  }
  bool SumCurvatureInDouble() override { return sums_.SumCurvatureInDouble(); }
  double HessianRounding() const override { return 10.0 * std::numeric_limits<T>::epsilon(); }
  const EnergyWork& energy_work() const override { return energy_.work(); }

  double Cost(const double* weights) override {
    const AlignedVector<T> w = Converted(weights);
    return sums_.Cost(w.data()) + energy_.Cost(w.data());
  }

  using Objective::Linearize;
  bool Linearize(const double* weights, CurvaturePart part, Linearization* at) override {
    const AlignedVector<T> w = Converted(weights);
    at->cost = 0.0;
    at->gradient.assign(w.size(), 0.0);
    at->hessian.assign(w.size() * w.size(), 0.0);
    sums_.AddCurvature(w.data(), weights, part, at);
    energy_.Linearize(w.data(), at);
    return IsFinite(*at);
  }

  std::vector<double> Curve(const double* weights, const double* direction,
                            CurvaturePart part) override {
    return sums_.Curve(weights, direction, part);
  }

  bool Gradient(const double* weights, double* cost, double* gradient) override {
    const AlignedVector<T> w = Converted(weights);
    Linearization at;  // its hessian stays empty
    at.gradient.assign(w.size(), 0.0);
    sums_.AddGradient(w.data(), &at);
    energy_.Linearize(w.data(), &at);
    *cost = at.cost;
    std::copy(at.gradient.begin(), at.gradient.end(), gradient);
    return IsFinite(at);
  }

  double MeanAbsLogError(const double* weights) override {
    return sums_.MeanAbsLogError(Converted(weights).data());
  }

 private:
  AlignedVector<T> Converted(const double* weights) const {
    return AlignedVector<T>(weights, weights + shape_.num_weights());
  }

  std::unique_ptr<EncodedSamples> owned_;
  NetworkShape shape_;
  SampleSums<T> sums_;
  EnergyTerm<T> energy_;
};

std::unique_ptr<Objective> Make(const FitProblem& problem, Precision precision,
                                const EncodedSamples& samples, std::size_t count,
                                std::unique_ptr<EncodedSamples> owned) {
  if (precision == Precision::kDouble) {
    return std::make_unique<SumObjective<double>>(problem, samples, count, std::move(owned));
  }
  return std::make_unique<SumObjective<float>>(problem, samples, count, std::move(owned));
}

}  // namespace

std::unique_ptr<Objective> MakeObjective(const FitProblem& problem, Precision precision,
                                         const EncodedSamples& samples, std::size_t count) {
  return Make(problem, precision, samples, count, nullptr);
}

std::unique_ptr<Objective> MakeObjective(const FitProblem& problem, Precision precision,
                                         std::span<const BrdfSample> samples) {
  auto owned = std::make_unique<EncodedSamples>(problem.Shape().encoding(), samples);
  const EncodedSamples& encoded = *owned;
  return Make(problem, precision, encoded, encoded.size(), std::move(owned));
}

}  // namespace pbnbrdf
