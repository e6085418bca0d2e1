// pairwise_walk.h: combinations of the levels of several factors, chosen so that every pair of levels
// of two factors appears early: the usual way to cover a product that is far too large to run
// through.
#pragma once

#include <cstddef>
#include <functional>
#include <random>
#include <vector>

namespace pbnbrdf {

// Each combination is the one of a few random ones that has the most pairs of levels that no earlier
// one had; of equal ones the first. The same arguments give the same walk.
class PairwiseWalk {
 public:
  // Whether level a of factor f can't go with level b of factor g, f < g.
  using Excludes = std::function<bool(int f, int a, int g, int b)>;

  // levels: how many each factor has, >= 1. Combinations without an excluded pair must not be rare,
  // since they are found by drawing.
  PairwiseWalk(std::vector<int> levels, Excludes excludes, unsigned seed);

  // The next combination: a level of each factor.
  std::vector<int> Next();

  // Of the pairs of levels of two factors: those that have appeared, and those that can.
  std::size_t seen_pairs() const { return seen_pairs_; }
  std::size_t possible_pairs() const { return possible_pairs_; }

 private:
  std::vector<int> Draw();
  bool IsPossible(const std::vector<int>& combination) const;
  std::size_t PairIndex(int f, int a, int g, int b) const;
  std::size_t CountNewPairs(const std::vector<int>& combination) const;
  void MarkPairs(const std::vector<int>& combination);

  std::vector<int> levels_, first_;  // first_: the number of a factor's level 0 among all levels
  Excludes excludes_;
  std::mt19937_64 random_;
  std::vector<bool> seen_;
  std::size_t seen_pairs_ = 0, possible_pairs_ = 0;
};

}  // namespace pbnbrdf
