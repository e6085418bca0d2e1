#include "pairwise_walk.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

bool Nothing(int, int, int, int) { return false; }

TEST(PairwiseWalk, AllPairsAppearLongBeforeAllCombinations) {
  PairwiseWalk walk({5, 4, 3, 6, 2, 2}, Nothing, /*seed=*/1);  // 1440 combinations
  EXPECT_EQ(walk.seen_pairs(), 0u);
  EXPECT_EQ(walk.possible_pairs(), 5u * 17 + 4 * 13 + 3 * 10 + 6 * 4 + 4);
  int count = 0;
  while (walk.seen_pairs() < walk.possible_pairs() && count < 1440) {
    walk.Next();
    ++count;
  }
  EXPECT_GE(count, 5 * 6);  // no fewer can do
  EXPECT_LT(count, 100);
}

TEST(PairwiseWalk, ExcludedPairsDontAppear) {
  const auto excludes = [](int f, int a, int g, int b) {
    return f == 0 && g == 2 && a == 1 && b > 0;
  };
  PairwiseWalk walk({2, 3, 3}, excludes, /*seed=*/2);
  EXPECT_EQ(walk.possible_pairs(), 2u * 3 + 2 * 3 + 3 * 3 - 2);
  for (int i = 0; i < 200; ++i) {
    const std::vector<int> levels = walk.Next();
    EXPECT_FALSE(levels[0] == 1 && levels[2] > 0);
  }
  EXPECT_EQ(walk.seen_pairs(), walk.possible_pairs());
}

TEST(PairwiseWalk, IsTheSameForTheSameSeed) {
  PairwiseWalk one({4, 4, 4}, Nothing, 1), same({4, 4, 4}, Nothing, 1),
      other({4, 4, 4}, Nothing, 2);
  bool differs = false;
  for (int i = 0; i < 20; ++i) {
    const std::vector<int> levels = one.Next();
    EXPECT_EQ(levels, same.Next());
    differs = differs || levels != other.Next();
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace pbnbrdf
