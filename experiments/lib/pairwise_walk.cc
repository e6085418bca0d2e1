#include "pairwise_walk.h"

namespace pbnbrdf {
namespace {

constexpr int kCandidates = 16;

}  // namespace

PairwiseWalk::PairwiseWalk(std::vector<int> levels, Excludes excludes, unsigned seed)
    : levels_(std::move(levels)), excludes_(std::move(excludes)), random_(seed) {
  int total = 0;
  for (int count : levels_) {
    first_.push_back(total);
    total += count;
  }
  first_.push_back(total);
  seen_.resize(static_cast<std::size_t>(total) * static_cast<std::size_t>(total));
  const int factors = static_cast<int>(levels_.size());
  for (int f = 0; f < factors; ++f) {
    for (int g = f + 1; g < factors; ++g) {
      for (int a = 0; a < levels_[f]; ++a) {
        for (int b = 0; b < levels_[g]; ++b) possible_pairs_ += !excludes_(f, a, g, b);
      }
    }
  }
}

std::vector<int> PairwiseWalk::Next() {
  std::vector<int> best = Draw();
  std::size_t most = CountNewPairs(best);
  for (int i = 1; i < kCandidates && seen_pairs_ < possible_pairs_; ++i) {
    std::vector<int> candidate = Draw();
    const std::size_t count = CountNewPairs(candidate);
    if (count <= most) continue;
    most = count;
    best.swap(candidate);
  }
  MarkPairs(best);
  return best;
}

std::vector<int> PairwiseWalk::Draw() {
  std::vector<int> combination(levels_.size());
  do {
    for (std::size_t f = 0; f < levels_.size(); ++f) {
      combination[f] = static_cast<int>(random_() % static_cast<std::uint64_t>(levels_[f]));
    }
  } while (!IsPossible(combination));
  return combination;
}

bool PairwiseWalk::IsPossible(const std::vector<int>& combination) const {
  const int factors = static_cast<int>(levels_.size());
  for (int f = 0; f < factors; ++f) {
    for (int g = f + 1; g < factors; ++g) {
      if (excludes_(f, combination[f], g, combination[g])) return false;
    }
  }
  return true;
}

std::size_t PairwiseWalk::PairIndex(int f, int a, int g, int b) const {
  return static_cast<std::size_t>(first_[f] + a) * static_cast<std::size_t>(first_.back()) +
         static_cast<std::size_t>(first_[g] + b);
}

std::size_t PairwiseWalk::CountNewPairs(const std::vector<int>& combination) const {
  const int factors = static_cast<int>(levels_.size());
  std::size_t count = 0;
  for (int f = 0; f < factors; ++f) {
    for (int g = f + 1; g < factors; ++g) {
      count += !seen_[PairIndex(f, combination[f], g, combination[g])];
    }
  }
  return count;
}

void PairwiseWalk::MarkPairs(const std::vector<int>& combination) {
  seen_pairs_ += CountNewPairs(combination);
  const int factors = static_cast<int>(levels_.size());
  for (int f = 0; f < factors; ++f) {
    for (int g = f + 1; g < factors; ++g) {
      seen_[PairIndex(f, combination[f], g, combination[g])] = true;
    }
  }
}

}  // namespace pbnbrdf
