// family_objective.h: the costs of all materials of a database.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "database/family_point.h"
#include "pbnbrdf/database/database_material.h"
#include "pbnbrdf/problem/objective.h"
#include "problem/encoded_samples.h"

namespace pbnbrdf {

class FamilyObjective {
 public:
  // problem: settled (FitProblem::For), without the energy term.
  FamilyObjective(std::span<const DatabaseMaterial> materials, const FitProblem& problem);

  std::size_t size() const { return objectives_.size(); }
  Objective& of(std::size_t m) { return *objectives_[m]; }
  std::span<const BrdfSample> samples(std::size_t m) const { return samples_[m].samples(); }

  // The sum over the materials; not finite where a network overflows.
  double Cost(const FamilyPoint& point);

  // False, with `at` unspecified, if something isn't finite.
  bool Linearize(const FamilyPoint& point, CurvaturePart part, FamilyLinearization* at);

 private:
  std::vector<EncodedSamples> samples_;
  std::vector<std::unique_ptr<Objective>> objectives_;
};

}  // namespace pbnbrdf
