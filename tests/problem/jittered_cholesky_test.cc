#include "problem/jittered_cholesky.h"

#include <Eigen/Core>

#include "test_util.h"

namespace pbnbrdf {
namespace {

Eigen::MatrixXd Lower(const JitteredCholesky& factor) {
  const int size = factor.lower.size();
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) lower(i, j) = factor.lower.row(i)[j];
  }
  return lower;
}

// size x rank, entries uniform in +-1.
Eigen::MatrixXd Random(int size, int rank) {
  const std::vector<double> numbers = RandomNumbers(size * rank, -1.0, 1.0, /*seed=*/1);
  return Eigen::Map<const Eigen::MatrixXd>(numbers.data(), size, rank);
}

TEST(JitteredCholesky, FactorsADefiniteMatrix) {
  const Eigen::MatrixXd b = Random(20, 20);
  const Eigen::MatrixXd a = b * b.transpose();
  const JitteredCholesky factor = FactorWithJitter(a.data(), 20, 1e-15);
  EXPECT_LE(factor.jitter, 1e-12);
  EXPECT_LT((Lower(factor) * Lower(factor).transpose() - a).norm(), 1e-10 * a.norm());
}

TEST(JitteredCholesky, AddsTheLeastJitterToASingularMatrix) {
  // Rank 5 of 20, badly scaled, a row of zeros.
  Eigen::MatrixXd b = Random(20, 5);
  for (int i = 0; i < 20; ++i) b.row(i) *= std::pow(10.0, i - 10);
  b.row(7).setZero();
  const Eigen::MatrixXd a = b * b.transpose();
  const JitteredCholesky factor = FactorWithJitter(a.data(), 20, 1e-15);
  EXPECT_LE(factor.jitter, 1e-12);
  const Eigen::MatrixXd product = Lower(factor) * Lower(factor).transpose();
  ASSERT_TRUE(product.allFinite());
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      if (i == 7 && j == 7) continue;  // the row of zeros has the jitter alone
      EXPECT_NEAR(product(i, j), a(i, j), 1e-11 * std::sqrt(product(i, i) * product(j, j)));
    }
  }
  EXPECT_GT(product(7, 7), 0.0);
}

TEST(JitteredCholesky, FactorsZero) {
  const std::vector<double> zero(9, 0.0);
  const JitteredCholesky factor = FactorWithJitter(zero.data(), 3, 1e-6);
  EXPECT_TRUE(Lower(factor).allFinite());
  EXPECT_GT(Lower(factor)(2, 2), 0.0);
}

}  // namespace
}  // namespace pbnbrdf
