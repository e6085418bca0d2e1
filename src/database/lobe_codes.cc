#include "database/lobe_codes.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "base/parallel.h"
#include "database/even_pairs.h"
#include "database/pca_rows.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr int kLobes = 400;
constexpr std::size_t kPairs = 2000;
constexpr double kSmallestCosine = 0.03;  // a few grazing values would decide, far off as they are
constexpr double kRidge = 1e-2;           // of codes, beside the sum over the pairs

}  // namespace

AnalyticBrdf Lobe(int n) {
  const auto [d, s, a] = EvenPoint(n + 1);
  const auto between = [](double min, double max, double u) {
    return min * std::pow(max / min, u);
  };
  return AnalyticBrdf::FromText(
      StrCat(n % 3 == 0 ? "ggx" : "cook_torrance", ":rho_d=", between(0.003, 0.9, d),
             ",f0=", between(0.01, 0.5, s), ",alpha=", between(0.03, 0.7, a)));
}

MatrixXd LobeCodes(const TablePca& pca) {
  const std::vector<DirectionPair> pairs = EvenPairs(kPairs, kSmallestCosine);
  MatrixXd values(pairs.size(), kLobes);
  ParallelFor(kLobes, [&](std::size_t k) {
    std::vector<Rgb> colors(pairs.size());
    Lobe(static_cast<int>(k)).Evaluate(pairs, colors);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      values(static_cast<Index>(n), static_cast<Index>(k)) = colors[n][0];
    }
  });
  const auto [rows, rests] = LinearSamplesAt(pca, pairs, values);
  MatrixXd normal = rows.transpose() * rows;
  normal.diagonal().array() += kRidge;
  return normal.llt().solve(rows.transpose() * rests);
}

}  // namespace pbnbrdf
