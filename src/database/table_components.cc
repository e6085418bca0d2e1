#include "pbnbrdf/database/table_components.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/about.h"
#include "base/parallel.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::MatrixXf;

constexpr Index kChunk = 4096;  // bins at a time

// A row of f for each bin, a column for each channel of each material; NaN where it isn't known.
MatrixXf ValuesOf(std::span<const DatabaseMaterial> materials,
                  const std::vector<DirectionPair>& pairs) {
  MatrixXf values(pairs.size(), 3 * materials.size());
  ParallelFor(materials.size(), [&](std::size_t m) {
    const auto& [name, brdf] = materials[m];
    if (!brdf->IsIsotropic()) Fail(name, ": anisotropic, and a MERL table has no phi_h");
    std::vector<Rgb> found(pairs.size());
    brdf->Evaluate(pairs, found);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const bool is_known = brdf->IsKnown(pairs[n]);
      for (std::size_t c = 0; c < 3; ++c) {
        values(static_cast<Index>(n), static_cast<Index>(3 * m + c)) =
            is_known ? static_cast<float>(found[n][c]) : std::nanf("");
      }
    }
  });
  return values;
}

float MedianOf(std::vector<float> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](float f) { return std::isnan(f); }),
               values.end());
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What the mapping needs besides the values: of each bin.
struct Centre {
  std::vector<float> median, mean;
};

// Maps the values in place and takes the mean off.
Centre MapAndCentre(const std::vector<DirectionPair>& pairs, MatrixXf* values) {
  Centre centre = {std::vector<float>(pairs.size()), std::vector<float>(pairs.size())};
  const Index chunks = (values->rows() + kChunk - 1) / kChunk;
  ParallelFor(static_cast<std::size_t>(chunks), [&](std::size_t chunk) {
    const Index begin = static_cast<Index>(chunk) * kChunk,
                end = std::min(begin + kChunk, values->rows());
    for (Index n = begin; n < end; ++n) {
      const auto& [wi, wo] = pairs[static_cast<std::size_t>(n)];
      auto row = values->row(n);
      const float median = MedianOf({row.begin(), row.end()});
      for (float& f : row) {
        f = std::isnan(f) ? 0.0f : static_cast<float>(TablePca::Mapped(f, median, wi.z * wo.z));
      }
      const float mean = row.mean();
      row.array() -= mean;
      centre.median[static_cast<std::size_t>(n)] = median;
      centre.mean[static_cast<std::size_t>(n)] = mean;
    }
  });
  return centre;
}

// values' values, chunk by chunk: sums of many terms in double precision.
MatrixXd InnerProducts(const MatrixXf& values) {
  MatrixXd sum = MatrixXd::Zero(values.cols(), values.cols());
  for (Index begin = 0; begin < values.rows(); begin += kChunk) {
    const auto part = values.middleRows(begin, std::min(kChunk, values.rows() - begin));
    sum += (part.transpose() * part).cast<double>();
  }
  return sum;
}

}  // namespace

TablePca PrincipalComponents(std::span<const DatabaseMaterial> materials, int components) {
  const int observations = 3 * static_cast<int>(materials.size());
  const int largest = std::min(observations - 1, TablePca::kMaxComponents);
  if (components < 1 || components > largest) {
    Fail("components = ", components, "; must be 1 to ", largest, " for ", materials.size(),
         " materials");
  }
  std::vector<DirectionPair> pairs;
  for (const std::size_t bin : MerlBrdf::BinsAboveHorizon()) {
    pairs.push_back(MerlBrdf::CornerPair(bin));
  }
  MatrixXf values = ValuesOf(materials, pairs);
  Centre centre = MapAndCentre(pairs, &values);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(InnerProducts(values));
  // Codes of variance 1: the sum of their squares is the number of observations.
  const MatrixXd codes = solver.eigenvectors().rightCols(components).rowwise().reverse() *
                         std::sqrt(static_cast<double>(observations));
  const MatrixXf rows = values * (codes / static_cast<double>(observations)).cast<float>();
  std::vector<DatabaseMember> members;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    DatabaseMember member = {materials[m].name, {}};
    for (Index c = 0; c < 3; ++c) {
      const auto row = codes.row(static_cast<Index>(3 * m) + c);
      member.code.insert(member.code.end(), row.begin(), row.end());
    }
    members.push_back(std::move(member));
  }
  return TablePca(std::move(centre.median), std::move(centre.mean),
                  {rows.data(), rows.data() + rows.size()}, std::move(members));
}

}  // namespace pbnbrdf
