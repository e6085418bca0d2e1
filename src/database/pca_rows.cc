#include "database/pca_rows.h"

namespace pbnbrdf {

using Eigen::Index, Eigen::MatrixXd;

LinearSamples LinearSamplesAt(const TablePca& pca, std::span<const DirectionPair> pairs,
                              const MatrixXd& values) {
  const auto count = static_cast<Index>(pairs.size());
  LinearSamples samples = {MatrixXd(count, pca.num_components()), MatrixXd(count, values.cols())};
  for (Index n = 0; n < count; ++n) {
    const TablePca::Row row = pca.RowAt(pairs[static_cast<std::size_t>(n)]);
    samples.rows.row(n) =
        Eigen::Map<const Eigen::RowVectorXd>(row.components.data(), samples.rows.cols());
    for (Index c = 0; c < values.cols(); ++c) {
      samples.rests(n, c) = row.Mapped(values(n, c)) - row.mean;
    }
  }
  return samples;
}

LinearSamples LinearSamplesOf(const TablePca& pca, std::span<const BrdfSample> samples) {
  std::vector<DirectionPair> pairs;
  MatrixXd values(samples.size(), 3);
  for (const BrdfSample& sample : samples) {
    values.row(static_cast<Index>(pairs.size())) =
        Eigen::Map<const Eigen::RowVector3d>(sample.value.data());
    pairs.push_back(sample.pair);
  }
  return LinearSamplesAt(pca, pairs, values);
}

MatrixXd RowsAt(const TablePca& pca, std::span<const DirectionPair> pairs) {
  return LinearSamplesAt(pca, pairs, MatrixXd(pairs.size(), 0)).rows;
}

}  // namespace pbnbrdf
