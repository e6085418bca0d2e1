// stability_case.h: the factors of the stability sweep, and the fit that a level of each makes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pairwise_walk.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {

// What makes a fit hard, apart from its material.
enum class Stress {
  kNone,
  kOneSample,
  kFewSamples,      // fewer than weights
  kDuplicates,      // ten samples, each many times
  kCorners,         // among the samples all with theta_h, theta_d at 0 and pi/2 exactly
  kLargeWeights,    // initial weights 100 times as large
  kHugeWeights,     // 1e20 times
  kTinyWeights,     // 1e-20 times
  kZeroWeights,     // all 0
  kInfiniteWeight,  // one of them
  kDeadUnits,       // hidden biases of -1000
  kNarrow,          // a unit a layer, which is often dead from the start
  kFastAdam,        // a learning rate 100 times too high
};

inline constexpr NameTable<Stress, 13> kStresses = {{{"none", Stress::kNone},
                                                     {"one sample", Stress::kOneSample},
                                                     {"few samples", Stress::kFewSamples},
                                                     {"duplicates", Stress::kDuplicates},
                                                     {"corners", Stress::kCorners},
                                                     {"large weights", Stress::kLargeWeights},
                                                     {"huge weights", Stress::kHugeWeights},
                                                     {"tiny weights", Stress::kTinyWeights},
                                                     {"zero weights", Stress::kZeroWeights},
                                                     {"infinite weight", Stress::kInfiniteWeight},
                                                     {"dead units", Stress::kDeadUnits},
                                                     {"narrow", Stress::kNarrow},
                                                     {"fast adam", Stress::kFastAdam}}};

struct StabilityFactor {
  std::string name;
  std::vector<std::string> levels;
};

struct SweepSize {
  std::uint64_t seeds = 3;  // how many
  int max_iterations = 12;
  std::uint64_t samples = 400;
};

// A fit of the sweep. The material's name is that of MakeSweepMaterial.
struct StabilityCase {
  std::vector<std::string> levels;  // of each factor, in the order of the factors
  std::string material;
  Stress stress = Stress::kNone;
  FitProblem problem;
  FitOptions options;  // without initial weights, which depend on the samples
};

class StabilitySweep {
 public:
  // sgd: a CSV of parameters of the SGD model (models/sgd.h), whose materials take part too, or "".
  // Throws Error.
  StabilitySweep(const SweepSize& size, const std::string& sgd);

  const std::vector<StabilityFactor>& factors() const { return factors_; }

  // The next case of the walk through all combinations.
  StabilityCase Next();

  const PairwiseWalk& walk() const { return walk_; }

 private:
  SweepSize size_;
  std::vector<StabilityFactor> factors_;
  PairwiseWalk walk_;
};

// A name among the factor "material"'s levels: of an extreme material, a built-in one or
// "sgd:FILE#NAME".
std::unique_ptr<Brdf> MakeSweepMaterial(const std::string& name);

}  // namespace pbnbrdf
