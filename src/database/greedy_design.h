// greedy_design.h: which of many possible measurements to make, of a linear model with normal noise.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pbnbrdf {

// Of one material: rows by which its values depend on its code, K numbers that are normal before anything is
// measured.
struct LinearModel {
  int rows_each = 1;           // rows of a measurement: channels
  Eigen::MatrixXd candidates;  // (rows_each * candidates) x K, divided by the noise
  Eigen::MatrixXd known;       // what was measured already: rows x K, divided by the noise
  Eigen::MatrixXd goal;        // K x K: the mean square error is the trace of goal * covariance
};

// Of the candidates, which all models have in common: `count` of them, each the one that takes most off the sum of the
// models' mean square errors, after those before. None twice.
std::vector<std::size_t> GreedyDesign(const std::vector<LinearModel>& models, int count);

}  // namespace pbnbrdf
