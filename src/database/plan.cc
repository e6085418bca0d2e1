#include "pbnbrdf/database/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "database/even_pairs.h"
#include "database/greedy_design.h"
#include "database/pca_rows.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kMembers = 16;  // of a database, that a plan is good for in the mean
constexpr double kDifference = 0.05;  // of a code's number, for derivatives
constexpr std::size_t kGoals = 2000;  // directions at which errors count

// log(1 + f cos theta_i), 3 numbers for each pair.
Eigen::VectorXd LogsAt(const Brdf& brdf, const std::vector<DirectionPair>& pairs) {
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  Eigen::VectorXd logs(3 * pairs.size());
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      logs[static_cast<Index>(3 * n + c)] = std::log1p(values[n][c] * CosI(pairs[n]));
    }
  }
  return logs;
}

// Its derivative with respect to the code there: (3 * pairs) x K.
MatrixXd SlopesAt(const WeightFamily& family, const std::vector<double>& code,
                  const std::vector<DirectionPair>& pairs) {
  MatrixXd slopes(3 * pairs.size(), family.code_size());
  for (std::size_t k = 0; k < code.size(); ++k) {
    const auto logs = [&](double change) {
      std::vector<double> changed = code;
      changed[k] += change;
      return LogsAt(NeuralBrdf(family.shape(), family.WeightsAt(changed)), pairs);
    };
    slopes.col(static_cast<Index>(k)) =
        (logs(kDifference) - logs(-kDifference)) / (2.0 * kDifference);
  }
  return slopes;
}

LinearModel ModelAt(const WeightFamily& family, const std::vector<double>& code,
                    const std::vector<DirectionPair>& candidates,
                    const std::vector<DirectionPair>& known) {
  const MatrixXd goals = SlopesAt(family, code, EvenPairs(kGoals));
  return {.rows_each = 3,
          .candidates = SlopesAt(family, code, candidates) / kFamilyNoise,
          .known = SlopesAt(family, code, known) / kFamilyNoise,
          .goal = goals.transpose() * goals / static_cast<double>(goals.rows())};
}

// The codes that a plan is for: of what was measured, or else of members all over the database.
std::vector<std::vector<double>> CodesOf(const WeightFamily& family,
                                         std::span<const BrdfSample> measured) {
  if (!measured.empty()) return {FitCode(family, measured)};
  std::vector<std::vector<double>> codes;
  const std::size_t count = std::min(kMembers, family.members().size());
  for (std::size_t k = 0; k < count; ++k) {
    codes.push_back(family.members()[k * family.members().size() / count].code);
  }
  return codes;
}

std::vector<DirectionPair> PairsOf(std::span<const BrdfSample> samples) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : samples) pairs.push_back(sample.pair);
  return pairs;
}

std::vector<DirectionPair> Chosen(const std::vector<LinearModel>& models,
                                  const std::vector<DirectionPair>& candidates, int count) {
  if (static_cast<std::size_t>(count) > candidates.size()) {
    Fail("count = ", count, "; the grid has ", candidates.size(), " pairs of directions");
  }
  std::vector<DirectionPair> chosen;
  for (const std::size_t k : GreedyDesign(models, count)) chosen.push_back(candidates[k]);
  return chosen;
}

void Check(const char* name, double value, double min, double max) {
  if (!(value >= min && value <= max)) {
    Fail(name, " = ", value, "; must be ", min, " to ", max);
  }
}

void Check(const PlanOptions& options) {
  Check("count", options.count, 1, 10000);
  Check("max_theta", options.max_theta, 1, 89);
  Check("theta_step", options.theta_step, 1, options.max_theta);
  Check("phi_step", options.phi_step, 1, 180);
}

}  // namespace

std::vector<DirectionPair> CandidatePairs(const PlanOptions& options) {
  std::vector<DirectionPair> pairs;
  const int thetas = static_cast<int>(options.max_theta / options.theta_step + 1e-9);
  const int phis = static_cast<int>(180.0 / options.phi_step + 1e-9);
  for (int i = 0; i <= thetas; ++i) {
    for (int o = 0; o <= i; ++o) {
      for (int p = 0; p <= (o == 0 ? 0 : phis); ++p) {
        pairs.push_back(
            {FromSpherical(i * options.theta_step * kDegree, 0.0),
             FromSpherical(o * options.theta_step * kDegree, p * options.phi_step * kDegree)});
      }
    }
  }
  return pairs;
}

std::vector<DirectionPair> PlanDirections(const WeightFamily& family,
                                          std::span<const BrdfSample> measured,
                                          const PlanOptions& options) {
  Check(options);
  const std::vector<DirectionPair> candidates = CandidatePairs(options), known = PairsOf(measured);
  const std::vector<std::vector<double>> codes = CodesOf(family, measured);
  std::vector<LinearModel> models(codes.size());
  ParallelFor(codes.size(),
              [&](std::size_t m) { models[m] = ModelAt(family, codes[m], candidates, known); });
  return Chosen(models, candidates, options.count);
}

std::vector<DirectionPair> PlanDirections(const TablePca& pca, std::span<const BrdfSample> measured,
                                          const PlanOptions& options) {
  Check(options);
  const std::vector<DirectionPair> candidates = CandidatePairs(options);
  const MatrixXd goals = RowsAt(pca, EvenPairs(kGoals));
  const LinearModel model = {.rows_each = 1,
                             .candidates = RowsAt(pca, candidates) / kPcaNoise,
                             .known = RowsAt(pca, PairsOf(measured)) / kPcaNoise,
                             .goal = goals.transpose() * goals / double(goals.rows())};
  return Chosen({model}, candidates, options.count);
}

}  // namespace pbnbrdf
