#include "database/pca_rows.h"

namespace pbnbrdf {

using Eigen::Index, Eigen::MatrixXd;

MatrixXd RowsAt(const TablePca& pca, std::span<const DirectionPair> pairs) {
  MatrixXd rows(pairs.size(), pca.num_components());
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const std::vector<double> row = pca.RowAt(pairs[n]).components;
    rows.row(static_cast<Index>(n)) =
        Eigen::Map<const Eigen::VectorXd>(row.data(), rows.cols()).transpose();
  }
  return rows;
}

LinearSamples LinearSamplesOf(const TablePca& pca, std::span<const BrdfSample> samples) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : samples) pairs.push_back(sample.pair);
  MatrixXd rests(samples.size(), 3);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const TablePca::Row row = pca.RowAt(pairs[n]);
    for (std::size_t c = 0; c < 3; ++c) {
      rests(static_cast<Index>(n), static_cast<Index>(c)) =
          row.Mapped(samples[n].value[c]) - row.mean;
    }
  }
  return {RowsAt(pca, pairs), std::move(rests)};
}

}  // namespace pbnbrdf
