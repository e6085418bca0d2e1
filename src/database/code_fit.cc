#include "pbnbrdf/database/code_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "database/code_minimizer.h"
#include "database/lobe_codes.h"
#include "database/pca_rows.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t kStarts = 4;  // members, besides the mean
// Of principal components: how far a material may be from those that it resembles, in mapped values; the weight of
// those that it doesn't resemble.
constexpr double kWidths[] = {0.25, 0.5, 1.0}, kLeastWeight = 1e-3;
constexpr double kLobesWeight = 5.0 / 3.0;  // of all of them, members' channels being 1

FitProblem ProblemOf(const WeightFamily& family, double noise) {
  FitProblem problem;
  problem.network = NetworkOptions::Of(family.shape());
  problem.terms.weights = {{"log", 1.0}};
  problem.terms.loss_scale = noise;
  return problem;
}

// The mean's code and those of the members that cost least, likeliest first.
std::vector<std::vector<double>> StartsOf(const WeightFamily& family, double ridge,
                                          Objective* objective) {
  std::vector<CodeMinimum> starts;
  for (const DatabaseMember& member : family.members()) {
    double square = 0.0;
    for (const double number : member.code) square += number * number;
    const double cost = objective->Cost(family.WeightsAt(member.code).data());
    starts.push_back({member.code, cost + 0.5 * ridge * square});
  }
  const std::size_t count = std::min(kStarts, starts.size());
  const auto by_cost = [](const CodeMinimum& a, const CodeMinimum& b) { return a.cost < b.cost; };
  std::partial_sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count),
                    starts.end(), by_cost);
  std::vector<std::vector<double>> codes = {
      std::vector<double>(static_cast<std::size_t>(family.code_size()))};
  for (std::size_t k = 0; k < count; ++k) codes.push_back(std::move(starts[k].code));
  return codes;
}

// What a channel may resemble.
struct Examples {
  MatrixXd codes;    // a column each
  VectorXd weights;  // before anything is measured
};

// The channels of the members, and lobes.
Examples ExamplesOf(const TablePca& pca) {
  const Index size = pca.num_components(), channels = 3 * static_cast<Index>(pca.members().size());
  const MatrixXd lobes = LobeCodes(pca);
  Examples examples = {MatrixXd(size, channels + lobes.cols()), VectorXd(channels + lobes.cols())};
  Index column = 0;
  for (const DatabaseMember& member : pca.members()) {
    examples.codes.middleCols(column, 3) = Eigen::Map<const MatrixXd>(member.code.data(), size, 3);
    column += 3;
  }
  examples.codes.rightCols(lobes.cols()) = lobes;
  examples.weights.head(channels).setConstant(1.0 / static_cast<double>(channels));
  examples.weights.tail(lobes.cols()).setConstant(kLobesWeight / static_cast<double>(lobes.cols()));
  return examples;
}

// Of one channel.
VectorXd ExpectedCode(const Examples& examples, const MatrixXd& rows, const VectorXd& rest,
                      double width, double noise) {
  const MatrixXd misses = (rows * examples.codes).colwise() - rest;
  const VectorXd distances = misses.colwise().squaredNorm() / static_cast<double>(rest.size());
  VectorXd weights =
      ((distances.minCoeff() - distances.array()) / (2.0 * width * width)).exp() + kLeastWeight;
  weights.array() *= examples.weights.array();
  weights /= weights.sum();
  const VectorXd mean = examples.codes * weights;
  const MatrixXd scaled = (examples.codes.colwise() - mean) *
                          weights.cwiseSqrt().asDiagonal();  // its square: the covariance
  const MatrixXd reach = rows * scaled;
  MatrixXd covariance = reach * reach.transpose();
  covariance.diagonal().array() += noise * noise;
  return mean + scaled * (reach.transpose() * covariance.llt().solve(rest - rows * mean));
}

}  // namespace

std::vector<double> FitCode(const WeightFamily& family, std::span<const BrdfSample> samples,
                            double noise) {
  if (samples.empty()) Fail("no measurements to find a code from");
  const FitProblem problem = ProblemOf(family, noise);
  const auto objective = MakeObjective(problem, Precision::kDouble, samples);
  const double ridge = noise * noise / static_cast<double>(samples.size());
  CodeMinimum best = {{}, std::numeric_limits<double>::infinity()};
  for (std::vector<double>& start : StartsOf(family, ridge, objective.get())) {
    CodeMinimum minimum = MinimizeOverCode(family, ridge, std::move(start), objective.get());
    if (minimum.cost < best.cost) best = std::move(minimum);
  }
  if (best.code.empty()) Fail("no code has a finite cost");
  return best.code;
}

std::vector<double> FitCode(const TablePca& pca, std::span<const BrdfSample> samples,
                            double noise) {
  if (samples.empty()) Fail("no measurements to find a code from");
  const Examples examples = ExamplesOf(pca);
  const auto [rows, rests] = LinearSamplesOf(pca, samples);
  const auto widths = static_cast<double>(std::size(kWidths));
  MatrixXd found = MatrixXd::Zero(pca.num_components(), 3);
  for (Index c = 0; c < 3; ++c) {
    for (const double width : kWidths) {
      found.col(c) += ExpectedCode(examples, rows, rests.col(c), width, noise) / widths;
    }
  }
  return {found.data(), found.data() + found.size()};
}

}  // namespace pbnbrdf
