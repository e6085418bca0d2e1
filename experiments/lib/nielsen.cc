#include "nielsen.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "database/pca_rows.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr double kEta = 40.0;  // for components scaled by singular values
constexpr int kMaxRounds = 20;

// Of as many components as there are rows.
double ConditionNumber(const MatrixXd& all, const std::vector<Index>& chosen) {
  const Index columns = std::min<Index>(static_cast<Index>(chosen.size()), all.cols());
  MatrixXd rows(chosen.size(), columns);
  for (std::size_t n = 0; n < chosen.size(); ++n) {
    rows.row(static_cast<Index>(n)) = all.row(chosen[n]).head(columns);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(rows.transpose() * rows,
                                                       Eigen::EigenvaluesOnly);
  const double least = std::max(solver.eigenvalues().minCoeff(), 0.0);
  return std::sqrt(solver.eigenvalues().maxCoeff() / std::max(least, 1e-300));
}

// The index for which value(index), computed in parallel, is least.
template <typename Function>
Index ArgMin(Index count, Function value) {
  std::vector<double> values(static_cast<std::size_t>(count));
  ParallelFor(values.size(), [&](std::size_t k) { values[k] = value(static_cast<Index>(k)); });
  return static_cast<Index>(std::min_element(values.begin(), values.end()) - values.begin());
}

// Whether a choice has moved to a neighbour.
bool MoveOne(const MatrixXd& all, std::size_t n, double* condition, std::vector<Index>* chosen) {
  bool moved = false;
  for (const Index step : {-1, 1}) {
    const Index next = (*chosen)[n] + step;
    if (next < 0 || next >= all.rows()) continue;
    if (std::find(chosen->begin(), chosen->end(), next) != chosen->end()) continue;
    std::vector<Index> trial = *chosen;
    trial[n] = next;
    const double number = ConditionNumber(all, trial);
    if (!(number < *condition)) continue;
    *condition = number;
    *chosen = std::move(trial);
    moved = true;
  }
  return moved;
}

}  // namespace

std::vector<DirectionPair> NielsenDirections(const TablePca& pca,
                                             const std::vector<DirectionPair>& candidates,
                                             int count) {
  const MatrixXd all = RowsAt(pca, candidates);
  std::vector<Index> chosen(1);
  all.rowwise().squaredNorm().maxCoeff(&chosen[0]);
  while (chosen.size() < static_cast<std::size_t>(count)) {
    chosen.push_back(ArgMin(all.rows(), [&](Index k) {
      if (std::find(chosen.begin(), chosen.end(), k) != chosen.end()) {
        return std::numeric_limits<double>::infinity();
      }
      std::vector<Index> trial = chosen;
      trial.push_back(k);
      return ConditionNumber(all, trial);
    }));
  }
  double condition = ConditionNumber(all, chosen);
  bool moved = true;
  for (int round = 0; round < kMaxRounds && moved; ++round) {
    moved = false;
    for (std::size_t n = 0; n < chosen.size(); ++n) {
      moved |= MoveOne(all, n, &condition, &chosen);
    }
  }
  std::vector<DirectionPair> pairs;
  for (const Index k : chosen) pairs.push_back(candidates[static_cast<std::size_t>(k)]);
  return pairs;
}

std::vector<double> NielsenCode(const TablePca& pca, std::span<const BrdfSample> samples) {
  const auto [all, rests] = LinearSamplesOf(pca, samples);
  const Index used = std::min(all.rows(), all.cols());
  const MatrixXd rows = all.leftCols(used);
  // Our components are theirs divided by the root of the number of observations.
  MatrixXd normal = rows.transpose() * rows;
  normal.diagonal().array() += kEta / (3.0 * static_cast<double>(pca.members().size()));
  MatrixXd codes = MatrixXd::Zero(pca.num_components(), 3);
  codes.topRows(used) = normal.llt().solve(rows.transpose() * rests);
  return {codes.data(), codes.data() + codes.size()};
}

}  // namespace pbnbrdf
