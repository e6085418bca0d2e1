// family_point.h: the unknowns of a database's shared network.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pbnbrdf {

struct FamilyPoint {
  Eigen::MatrixXd weights;  // P x (1 + K): mean, and basis
  Eigen::MatrixXd codes;    // M x K

  Eigen::Index code_size() const { return codes.cols(); }
  Eigen::Index num_materials() const { return codes.rows(); }

  auto basis() const { return weights.rightCols(code_size()); }

  // Of material m's network, P numbers.
  Eigen::VectorXd WeightsOf(Eigen::Index m) const {
    return weights.col(0) + basis() * codes.row(m).transpose();
  }

  // M x (1 + K): by what each material multiplies the columns of `weights`.
  Eigen::MatrixXd Factors() const {
    Eigen::MatrixXd factors(num_materials(), 1 + code_size());
    factors << Eigen::VectorXd::Ones(num_materials()), codes;
    return factors;
  }
};

// The sum of the materials' costs to second order, as Gauss and Newton have it. J'J of a material takes P^2 floats:
// they are what the memory is for.
struct FamilyLinearization {
  double cost = 0.0;
  std::vector<Eigen::MatrixXf>
      hessians;               // M times P x P, with respect to the material's own weights
  Eigen::MatrixXd gradients;  // P x M
};

}  // namespace pbnbrdf
