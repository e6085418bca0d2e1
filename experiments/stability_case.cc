#include "stability_case.h"

#include <algorithm>
#include <set>

#include "base/text.h"
#include "extreme_materials.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/open_brdf.h"

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

struct Terms {
  double log, chromaticity, energy;
};

constexpr NameTable<Terms, 5> kTermSets = {{{"log", {1.0, 0.0, 0.0}},
                                            {"chromaticity", {0.0, 1.0, 0.0}},
                                            {"log+chromaticity", {1.0, 0.1, 0.0}},
                                            {"log+energy", {1.0, 0.0, 1.0}},
                                            {"log+chromaticity+energy", {1.0, 0.1, 1.0}}}};

constexpr unsigned kWalkSeed = 1;
constexpr std::size_t kMostTableBytes = 1 << 20;

template <typename Enum, std::size_t N>
std::vector<std::string> Names(const NameTable<Enum, N>& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.emplace_back(name);
  return names;
}

// The materials in the first column of the file, one after the other.
std::vector<std::string> SgdMaterials(const std::string& path) {
  std::vector<std::string> materials;
  std::set<std::string> seen;
  const std::vector<std::string> lines = Split(ReadFile(path, kMostTableBytes), '\n');
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string name = lines[i].substr(0, lines[i].find(','));
    if (!name.empty() && seen.insert(name).second) {
      materials.push_back("sgd:" + path + "#" + name);
    }
  }
  if (materials.empty()) Fail(path, ": names no material");
  return materials;
}

std::vector<StabilityFactor> MakeFactors(const SweepSize& size, const std::string& sgd) {
  std::vector<std::string> materials, seeds;
  for (const ExtremeMaterial& material : ExtremeMaterials()) materials.emplace_back(material.name);
  for (const BuiltinMaterial& material : BuiltinMaterials()) materials.emplace_back(material.name);
  if (!sgd.empty()) {
    const std::vector<std::string> more = SgdMaterials(sgd);
    materials.insert(materials.end(), more.begin(), more.end());
  }
  for (std::size_t seed = 1; seed <= size.seeds; ++seed) seeds.push_back(StrCat(seed));
  return {{"material", materials},
          {"stress", Names(kStresses)},
          {"solver", Names(kSolvers)},
          {"loss", Names(kLosses)},
          {"terms", Names(kTermSets)},
          {"encoding", Names(kEncodings)},
          {"precision", Names(kPrecisions)},
          {"activation", Names(kActivations)},
          {"initialization", Names(kInitializations)},
          {"sampling", Names(kSamplings)},
          {"seed", seeds}};
}

// Solvers of second order take no absolute values, and but one solver has a learning rate.
bool Excludes(int f, int a, int g, int b) {
  if (f == kStress && g == kSolver) {
    return kStresses[a].second == Stress::kFastAdam && kSolvers[b].second != Solver::kAdam;
  }
  if (f == kSolver && g == kLoss) {
    const Solver solver = kSolvers[a].second;
    return (solver == Solver::kTinyLm || solver == Solver::kLm) &&
           kLosses[b].second == Loss::kAbsolute;
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
  problem.hidden = {8, 8};
  problem.samples = size.samples;
  problem.first_samples = std::max<std::size_t>(size.samples / 3, 1);
  problem.energy_strata = 4;
  problem.energy_theta = 16;
  problem.energy_phi = 8;
  problem.loss = kLosses[level[kLoss]].second;
  const Terms& terms = kTermSets[level[kTerms]].second;
  problem.log_weight = terms.log;
  problem.chromaticity_weight = terms.chromaticity;
  problem.energy_weight = terms.energy;
  problem.encoding = kEncodings[level[kEncoding]].second;
  problem.precision = kPrecisions[level[kPrecision]].second;
  problem.activation = kActivations[level[kActivation]].second;
  problem.initialization = kInitializations[level[kInitialization]].second;
  problem.sampling = kSamplings[level[kSampling]].second;
  problem.seed = static_cast<std::uint64_t>(level[kSeed]) + 1;
  return problem;
}

void ApplyStress(StabilityCase* to) {
  if (to->stress == Stress::kOneSample) to->problem.samples = 1;
  if (to->stress == Stress::kFewSamples) to->problem.samples = 20;
  if (to->stress == Stress::kNarrow) to->problem.hidden = {1, 1};
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
  made.options.solver = kSolvers[level[kSolver]].second;
  made.options.max_iterations = size_.max_iterations;
  made.options.curvature_samples = std::max<std::size_t>(size_.samples / 2, 1);
  made.options.adam.batch = 64;
  made.options.threads = 1;
  ApplyStress(&made);
  return made;
}

std::unique_ptr<Brdf> MakeSweepMaterial(const std::string& name) {
  return name.starts_with("sgd:") ? OpenBrdf(name) : MakeExtremeOrBuiltin(name);
}

}  // namespace pbnbrdf
