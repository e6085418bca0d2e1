// table_pca.h: a database of tables as principal components [1], the usual way to compress one.
//
// Each channel of a material is, bin by bin of a MERL table,
//
//   log((f w + e) / (m w + e)) = mean + sum over k of code_k component_k,
//
// w = max(cos_i cos_o, e) at the bin's corner, e = 0.001, and m the median of f over the database, all
// channels. Over the database each number of the codes has mean 0 and variance 1, and no two are correlated.
//
// [1] J. B. Nielsen, H. W. Jensen, R. Ramamoorthi. On Optimal, Minimal BRDF Sampling for Reflectance
//     Acquisition. ACM TOG 34(6), 2015.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/network/database_member.h"
#include "pbnbrdf/sources/merl.h"

namespace pbnbrdf {

class TablePca {
 public:
  static constexpr int kMaxComponents = 256;
  static constexpr double kOffset = 1e-3;  // e above

  // Over the bins of MerlBrdf::BinsAboveHorizon(), B of them: median (1/sr) and mean B numbers each,
  // components K rows of B. A member's code: 3 K numbers, those of R, of G and of B. Throws Error if sizes
  // disagree.
  TablePca(std::vector<float> median, std::vector<float> mean, std::vector<float> components,
           std::vector<DatabaseMember> members);

  // A safetensors file of F32 tensors median, mean, components and codes, about 4.5 MB for each component;
  // in __metadata__ "format" (kFormat) and "materials". Throws Error.
  static TablePca Read(const std::string& path);
  void Write(const std::string& path) const;
  static constexpr std::string_view kFormat = "pbnbrdf-pca";

  int num_components() const { return num_components_; }
  const std::vector<DatabaseMember>& members() const { return members_; }

  // The table of a material with this code, 3 K numbers.
  MerlBrdf At(std::span<const double> code) const;

  // That of a member. Throws Error, which has the nearest name, if there is none of that name.
  MerlBrdf Material(const std::string& name) const;

  // At a pair between the corners of bins, the right side of the equation above, interpolated, and what its left
  // side needs besides f.
  struct Row {
    double cosines, median, mean;
    std::vector<double> components;  // K

    double Mapped(double f) const { return TablePca::Mapped(f, median, cosines); }
  };
  Row RowAt(const DirectionPair& pair) const;

  // The left side, of a value f (1/sr).
  static double Mapped(double f, double median, double cosines) {
    const double w = std::max(cosines, kOffset);
    return std::log((std::max(f, 0.0) * w + kOffset) / (median * w + kOffset));
  }

 private:
  int num_components_;
  std::vector<std::size_t> bins_;
  std::vector<int> place_;  // of each bin of a table in bins_, or -1
  std::vector<float> median_, mean_, components_;
  std::vector<DatabaseMember> members_;
};

}  // namespace pbnbrdf
