#include "database/family_step.h"

#include <Eigen/Cholesky>

#include "test_util.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd Random(Index rows, Index columns, unsigned seed) {
  const std::vector<double> numbers = RandomNumbers(rows * columns, -1.0, 1.0, seed);
  return Eigen::Map<const MatrixXd>(numbers.data(), rows, columns);
}

constexpr Index kWeights = 7, kCodes = 2, kMaterials = 5;

struct Case {
  FamilyPoint point = {Random(kWeights, 1 + kCodes, 1), Random(kMaterials, kCodes, 2)};
  FamilyLinearization at;

  Case() {
    at.gradients = Random(kWeights, kMaterials, 3);
    for (unsigned m = 0; m < kMaterials; ++m) {
      const MatrixXd root = Random(kWeights, 2 * kWeights, 10 + m);
      at.hessians.push_back((root * root.transpose()).cast<float>());
    }
  }
};

// The derivative of material m's weights with respect to all unknowns: the weights' columns, then the codes' rows.
MatrixXd Derivative(const FamilyPoint& point, Index m) {
  MatrixXd derivative = MatrixXd::Zero(kWeights, kWeights * (1 + kCodes) + kMaterials * kCodes);
  for (Index k = 0; k <= kCodes; ++k) {
    const double factor = k == 0 ? 1.0 : point.codes(m, k - 1);
    derivative.middleCols(k * kWeights, kWeights).diagonal().setConstant(factor);
  }
  derivative.middleCols(kWeights * (1 + kCodes) + m * kCodes, kCodes) = point.basis();
  return derivative;
}

VectorXd Flat(const FamilyPoint& point) {
  const MatrixXd rows = point.codes.transpose();
  VectorXd flat(point.weights.size() + rows.size());
  flat << point.weights.reshaped(), rows.reshaped();
  return flat;
}

TEST(FamilyStep, SolvesTheQuadraticModelAsADenseSolverDoes) {
  const Case c;
  constexpr double kRidge = 0.1, kRadius = 1e8;  // no damping to speak of
  MatrixXd matrix = MatrixXd::Zero(Flat(c.point).size(), Flat(c.point).size());
  VectorXd gradient = VectorXd::Zero(matrix.rows());
  for (Index m = 0; m < kMaterials; ++m) {
    const MatrixXd derivative = Derivative(c.point, m);
    matrix += derivative.transpose() * c.at.hessians[m].cast<double>() * derivative;
    gradient += derivative.transpose() * c.at.gradients.col(m);
  }
  const Index codes = kMaterials * kCodes;
  matrix.diagonal().tail(codes).array() += kRidge;
  gradient.tail(codes) += kRidge * Flat(c.point).tail(codes);
  const VectorXd wanted = matrix.ldlt().solve(-gradient);

  const FamilyStep step = DampedStep(c.point, c.at, kRidge, kRadius);
  // Conjugate gradients end at a thousandth of the residual's square.
  const VectorXd rest = matrix * Flat(step.change) + gradient;
  EXPECT_LT(rest.norm(), 0.1 * gradient.norm());
  EXPECT_NEAR(step.predicted, -0.5 * gradient.dot(wanted), 0.05 * step.predicted);
}

TEST(FamilyStep, DampingShortensIt) {
  const Case c;
  const double far = Flat(DampedStep(c.point, c.at, 0.1, 100.0).change).norm(),
               near = Flat(DampedStep(c.point, c.at, 0.1, 0.01).change).norm();
  EXPECT_LT(near, 0.1 * far);
  EXPECT_GT(near, 0.0);
}

TEST(FamilyStep, WithoutCodesItIsThatOfTheMeanAlone) {
  Case c;
  c.point = {c.point.weights.leftCols(1), MatrixXd(kMaterials, 0)};
  MatrixXd matrix = MatrixXd::Zero(kWeights, kWeights);
  for (const Eigen::MatrixXf& hessian : c.at.hessians) matrix += hessian.cast<double>();
  const VectorXd wanted = matrix.ldlt().solve(-c.at.gradients.rowwise().sum());
  const VectorXd found = DampedStep(c.point, c.at, 0.1, 1e8).change.weights;
  EXPECT_LT((found - wanted).norm(), 1e-3 * wanted.norm());
}

}  // namespace
}  // namespace pbnbrdf
