// weight_family.h: a database as one network: what its materials have in common, and a few numbers for each.
//
// The weights of a material's network are an affine function of its code,
//
//   w = mean + sum over k of code_k basis_k,
//
// so that each material is a network like any other: evaluated, exported and proved as one. Over the
// database the codes have mean 0 and covariance 1: that of a material which isn't in it is taken for a
// normal random vector.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/network/database_member.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

class WeightFamily {
 public:
  static constexpr int kMaxCodeSize = 256;

  // mean: shape.num_weights() numbers. basis: K rows of as many, 1 <= K <= kMaxCodeSize. Throws Error if
  // sizes disagree or something isn't finite.
  WeightFamily(const NetworkShape& shape, std::vector<double> mean, std::vector<double> basis,
               std::vector<DatabaseMember> members, NeuralBrdf::Metadata metadata = {});

  // A safetensors file: tensors mean (P), basis (K x P) and codes (M x K); in __metadata__ "format"
  // (kFormat), "encoding", "activation", "hidden" ("21,21"), "outputs" and "materials" (names between
  // semicolons). Throws Error.
  static WeightFamily Read(const std::string& path);
  void Write(const std::string& path) const;
  static constexpr std::string_view kFormat = "pbnbrdf-prior";

  const NetworkShape& shape() const { return shape_; }
  int code_size() const { return code_size_; }
  const std::vector<DatabaseMember>& members() const { return members_; }
  const std::vector<double>& mean() const { return mean_; }
  const std::vector<double>& basis() const { return basis_; }
  const NeuralBrdf::Metadata& metadata() const { return metadata_; }

  // The weights of a material with this code, code_size() numbers.
  std::vector<double> WeightsAt(std::span<const double> code) const;

  // The network of a member. Throws Error, which has the nearest name, if there is none of that name.
  NeuralBrdf Material(const std::string& name) const;

 private:
  NetworkShape shape_;
  int code_size_;
  std::vector<double> mean_, basis_;
  std::vector<DatabaseMember> members_;
  NeuralBrdf::Metadata metadata_;
};

}  // namespace pbnbrdf
