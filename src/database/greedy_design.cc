#include "database/greedy_design.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "base/parallel.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd;

class Posterior {
 public:
  explicit Posterior(const LinearModel& model)
      : model_(model), covariance_(MatrixXd::Identity(model.goal.rows(), model.goal.cols())) {
    if (model.known.rows() > 0) Add(model.known);
  }

  // What each candidate would take off the mean square error.
  Eigen::VectorXd Gains() const {
    const MatrixXd spread = model_.candidates * covariance_, reach = spread * model_.goal;
    const Index each = model_.rows_each, count = model_.candidates.rows() / each;
    Eigen::VectorXd gains(count);
    for (Index k = 0; k < count; ++k) {
      const auto own = spread.middleRows(k * each, each);
      MatrixXd variance = own * model_.candidates.middleRows(k * each, each).transpose();
      variance.diagonal().array() += 1.0;
      gains[k] = variance.llt().solve(reach.middleRows(k * each, each) * own.transpose()).trace();
    }
    return gains;
  }

  void AddCandidate(std::size_t k) {
    Add(model_.candidates.middleRows(static_cast<Index>(k) * model_.rows_each, model_.rows_each));
  }

 private:
  void Add(const MatrixXd& rows) {
    const MatrixXd spread = rows * covariance_;
    MatrixXd variance = spread * rows.transpose();
    variance.diagonal().array() += 1.0;
    covariance_ -= spread.transpose() * variance.llt().solve(spread);
  }

  const LinearModel& model_;
  MatrixXd covariance_;
};

}  // namespace

std::vector<std::size_t> GreedyDesign(const std::vector<LinearModel>& models, int count) {
  std::vector<Posterior> posteriors(models.begin(), models.end());
  std::vector<Eigen::VectorXd> gains(models.size());
  std::vector<std::size_t> chosen;
  for (int k = 0; k < count; ++k) {
    ParallelFor(models.size(), [&](std::size_t m) { gains[m] = posteriors[m].Gains(); });
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(gains.front().size());
    for (const Eigen::VectorXd& own : gains) sum += own;
    for (const std::size_t taken : chosen) sum[static_cast<Index>(taken)] = -1.0;
    Index best = 0;
    sum.maxCoeff(&best);
    chosen.push_back(static_cast<std::size_t>(best));
    ParallelFor(models.size(), [&](std::size_t m) { posteriors[m].AddCandidate(chosen.back()); });
  }
  return chosen;
}

}  // namespace pbnbrdf
