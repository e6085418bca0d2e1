// results.h: what several methods reach on several materials: a table for each quantity.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pbnbrdf {

// How a method's values are set against those of others over all materials.
enum class Comparison { kNone, kRatio, kDifference };

struct Quantity {
  std::string name;  // the table's heading
  int digits = 3;    // significant ones
  Comparison comparison = Comparison::kNone;
};

class Results {
 public:
  // `ours` is the method that comparisons are of. Tables come in the order of the quantities.
  Results(std::string ours, std::vector<Quantity> quantities);

  // quantity: one of the names. Materials and methods come in the order in which they first appear. A second
  // value takes the first one's place.
  void Add(const std::string& quantity, const std::string& material, const std::string& method,
           double value);

  // NaN if there is none.
  double Value(const std::string& quantity, const std::string& material,
               const std::string& method) const;

  // Of each quantity that has values: a row for each material and one for the medians, and below it the
  // comparisons of ours with each other method, over the materials that both have finite values of.
  std::string Markdown() const;

 private:
  using Values = std::map<std::pair<std::string, std::string>, double>;  // by material, method

  std::string TableOf(const Quantity& quantity, const Values& values) const;
  std::string ComparisonsOf(const Quantity& quantity, const Values& values) const;

  std::string ours_;
  std::vector<Quantity> quantities_;
  std::vector<std::string> materials_, methods_;
  std::map<std::string, Values> values_;  // by quantity
};

}  // namespace pbnbrdf
