// pca_rows.h: what samples say of a code of principal components: linear equations.
#pragma once

#include <Eigen/Core>
#include <span>

#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// A row for each pair: by what a channel's code is multiplied. N x K.
Eigen::MatrixXd RowsAt(const TablePca& pca, std::span<const DirectionPair> pairs);

struct LinearSamples {
  Eigen::MatrixXd rows;   // N x K
  Eigen::MatrixXd rests;  // N x 3: the mapped values of each channel without the mean
};

LinearSamples LinearSamplesOf(const TablePca& pca, std::span<const BrdfSample> samples);

}  // namespace pbnbrdf
