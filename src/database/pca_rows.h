// pca_rows.h: what samples say of a code of principal components: linear equations.
#pragma once

#include <Eigen/Core>
#include <span>

#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// rows * code = rests, for the code of each channel.
struct LinearSamples {
  Eigen::MatrixXd rows;   // N x K
  Eigen::MatrixXd rests;  // N x C: the mapped values of each of C channels without the mean
};

// values: f (1/sr), N x C, a row for each pair.
LinearSamples LinearSamplesAt(const TablePca& pca, std::span<const DirectionPair> pairs,
                              const Eigen::MatrixXd& values);

// C = 3.
LinearSamples LinearSamplesOf(const TablePca& pca, std::span<const BrdfSample> samples);

// The rows alone.
Eigen::MatrixXd RowsAt(const TablePca& pca, std::span<const DirectionPair> pairs);

}  // namespace pbnbrdf
