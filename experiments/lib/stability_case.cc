#include "stability_case.h"

#include <algorithm>

#include "extreme_materials.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "solve/solver.h"
#include "sources/source_list.h"

namespace pbnbrdf {
namespace {

enum FactorIndex {
  kMaterial,
  kStress,
  kSolver,
  kLoss,
  kTerms,
  kEncoding,
  kPrecision,
  kActivation,
  kInitialization,
  kSampling,
  kSeed,
};

struct TermSet {
  const char* name;
  std::vector<WeightedTerm> weights;
};

const std::vector<TermSet>& TermSets() {
  static const std::vector<TermSet> sets = {
      {"log", {{"log", 1.0}}},
      {"chromaticity", {{"chromaticity", 1.0}}},
      {"log+chromaticity", {{"log", 1.0}, {"chromaticity", 0.1}}},
      {"log+energy", {{"log", 1.0}, {"energy", 1.0}}},
      {"log+chromaticity+energy", {{"log", 1.0}, {"chromaticity", 0.1}, {"energy", 1.0}}}};
  return sets;
}

// All but the slow reference, which takes the same steps as ceres_lm.
const std::vector<const Solver*>& SweptSolvers() {
  static const std::vector<const Solver*> swept = [] {
    std::vector<const Solver*> solvers;
    for (const Solver& solver : Solvers()) {
      if (solver.name != "autodiff") solvers.push_back(&solver);
    }
    return solvers;
  }();
  return swept;
}

constexpr unsigned kWalkSeed = 1;

template <typename Enum, std::size_t N>
std::vector<std::string> Names(const NameTable<Enum, N>& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.emplace_back(name);
  return names;
}

std::vector<StabilityFactor> MakeFactors(const SweepSize& size, const std::string& sgd) {
  std::vector<std::string> materials, solvers, term_sets, seeds;
  for (const ExtremeMaterial& material : ExtremeMaterials()) materials.emplace_back(material.name);
  for (const BuiltinMaterial& material : BuiltinMaterials()) materials.emplace_back(material.name);
  if (!sgd.empty()) {
    const std::vector<std::string> more = ExpandSources("sgd:" + sgd + "#*");
    materials.insert(materials.end(), more.begin(), more.end());
  }
  for (const Solver* solver : SweptSolvers()) solvers.emplace_back(solver->name);
  for (const TermSet& set : TermSets()) term_sets.emplace_back(set.name);
  for (std::uint64_t seed = 1; seed <= size.seeds; ++seed) seeds.push_back(StrCat(seed));
  return {{"material", materials},
          {"stress", Names(kStresses)},
          {"solver", solvers},
          {"loss", Names(kLosses)},
          {"terms", term_sets},
          {"encoding", Names(kEncodings)},
          {"precision", Names(kPrecisions)},
          {"activation", Names(kActivations)},
          {"initialization", Names(kInitializations)},
          {"sampling", Names(kSamplings)},
          {"seed", seeds}};
}

// Only adam has a learning rate, and second-order solvers take no absolute values.
bool Excludes(int f, int a, int g, int b) {
  if (f == kStress && g == kSolver) {
    return kStresses[a].second == Stress::kFastAdam && !SweptSolvers()[b]->traits.is_stochastic;
  }
  if (f == kSolver && g == kLoss) {
    return SweptSolvers()[a]->traits.needs_squares && kLosses[b].second == Loss::kAbsolute;
  }
  return false;
}

std::vector<int> LevelCounts(const std::vector<StabilityFactor>& factors) {
  std::vector<int> counts;
  for (const StabilityFactor& factor : factors) {
    counts.push_back(static_cast<int>(factor.levels.size()));
  }
  return counts;
}

FitProblem MakeProblem(const std::vector<int>& level, const SweepSize& size) {
  FitProblem problem;
  problem.network.hidden = {8, 8};
  problem.network.encoding = kEncodings[level[kEncoding]].second;
  problem.network.activation = kActivations[level[kActivation]].second;
  problem.network.initialization = kInitializations[level[kInitialization]].second;
  problem.terms.weights = TermSets()[level[kTerms]].weights;
  problem.terms.loss = kLosses[level[kLoss]].second;
  problem.terms.energy_strata = 4;
  problem.terms.energy_theta = 16;
  problem.terms.energy_phi = 8;
  problem.sampling.angles = kSamplings[level[kSampling]].second;
  problem.sampling.samples = size.samples;
  problem.sampling.seed = static_cast<std::uint64_t>(level[kSeed]) + 1;
  return problem;
}

FitOptions MakeOptions(const std::vector<int>& level, const SweepSize& size) {
  FitOptions options;
  options.solver = SweptSolvers()[level[kSolver]]->name;
  options.precision = kPrecisions[level[kPrecision]].second;
  options.schedule.first_samples = std::max<std::uint64_t>(size.samples / 3, 1);
  options.schedule.curvature_samples = std::max<std::uint64_t>(size.samples / 2, 1);
  options.schedule.max_iterations = size.max_iterations;
  options.adam.batch = 64;
  options.threads = 1;
  return options;
}

void ApplyStress(StabilityCase* to) {
  if (to->stress == Stress::kOneSample) to->problem.sampling.samples = 1;
  if (to->stress == Stress::kFewSamples) to->problem.sampling.samples = 20;
  if (to->stress == Stress::kNarrow) to->problem.network.hidden = {1, 1};
  if (to->stress == Stress::kFastAdam) to->options.adam.learning_rate *= 100.0;
}

}  // namespace

StabilitySweep::StabilitySweep(const SweepSize& size, const std::string& sgd)
    : size_(size),
      factors_(MakeFactors(size, sgd)),
      walk_(LevelCounts(factors_), Excludes, kWalkSeed) {}

StabilityCase StabilitySweep::Next() {
  const std::vector<int> level = walk_.Next();
  StabilityCase made;
  for (std::size_t f = 0; f < level.size(); ++f) {
    made.levels.push_back(factors_[f].levels[level[f]]);
  }
  made.material = made.levels[kMaterial];
  made.stress = kStresses[level[kStress]].second;
  made.problem = MakeProblem(level, size_);
  made.options = MakeOptions(level, size_);
  ApplyStress(&made);
  return made;
}

std::unique_ptr<Brdf> MakeSweepMaterial(const std::string& name) {
  return name.starts_with("sgd:") ? OpenBrdf(name) : MakeExtremeOrBuiltin(name);
}

}  // namespace pbnbrdf
