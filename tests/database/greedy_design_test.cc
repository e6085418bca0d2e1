#include "database/greedy_design.h"

#include <Eigen/LU>

#include "test_util.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr Index kCode = 4, kEach = 2, kCandidates = 12;

MatrixXd Random(Index rows, Index columns, unsigned seed) {
  const std::vector<double> numbers = RandomNumbers(rows * columns, -1.0, 1.0, seed);
  return Eigen::Map<const MatrixXd>(numbers.data(), rows, columns);
}

LinearModel Model(unsigned seed) {
  const MatrixXd goal = Random(9, kCode, seed);
  return {kEach, Random(kEach * kCandidates, kCode, seed + 1), MatrixXd(0, kCode),
          goal.transpose() * goal};
}

// The mean square error after the rows were measured, by inverting the precision.
double ErrorAfter(const LinearModel& model, const MatrixXd& rows) {
  const MatrixXd precision = MatrixXd::Identity(kCode, kCode) + rows.transpose() * rows;
  return (model.goal * precision.inverse()).trace();
}

TEST(GreedyDesign, EachChoiceIsTheBestByInvertingTheWholePrecision) {
  const std::vector<LinearModel> models = {Model(1), Model(20), Model(40)};
  const std::vector<std::size_t> chosen = GreedyDesign(models, 5);
  ASSERT_EQ(chosen.size(), 5u);
  std::vector<MatrixXd> rows(models.size(), MatrixXd(0, kCode));
  for (std::size_t step = 0; step < chosen.size(); ++step) {
    std::vector<double> errors(kCandidates);
    for (std::size_t k = 0; k < kCandidates; ++k) {
      for (std::size_t m = 0; m < models.size(); ++m) {
        MatrixXd with(rows[m].rows() + kEach, kCode);
        with << rows[m], models[m].candidates.middleRows(static_cast<Index>(k) * kEach, kEach);
        errors[k] += ErrorAfter(models[m], with);
      }
    }
    for (std::size_t before = 0; before < step; ++before) errors[chosen[before]] = 1e9;
    EXPECT_EQ(std::min_element(errors.begin(), errors.end()) - errors.begin(),
              static_cast<std::ptrdiff_t>(chosen[step]));
    for (std::size_t m = 0; m < models.size(); ++m) {
      MatrixXd with(rows[m].rows() + kEach, kCode);
      with << rows[m],
          models[m].candidates.middleRows(static_cast<Index>(chosen[step]) * kEach, kEach);
      rows[m] = with;
    }
  }
}

TEST(GreedyDesign, WhatWasMeasuredCountsAsTheFirstChoices) {
  LinearModel model = Model(7);
  const std::vector<std::size_t> all = GreedyDesign({model}, 4);
  model.known.resize(2 * kEach, kCode);
  for (Index k = 0; k < 2; ++k) {
    model.known.middleRows(k * kEach, kEach) = model.candidates.middleRows(
        static_cast<Index>(all[static_cast<std::size_t>(k)]) * kEach, kEach);
  }
  EXPECT_THAT(GreedyDesign({model}, 2), testing::ElementsAre(all[2], all[3]));
}

}  // namespace
}  // namespace pbnbrdf
