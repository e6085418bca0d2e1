#include "results.h"

#include <cmath>

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::Not;

Results Some() {
  Results results("ours", {{"error", 2, Comparison::kRatio},
                           {"level", 3, Comparison::kDifference},
                           {"seconds", 2, Comparison::kNone},
                           {"absent", 2, Comparison::kNone}});
  for (int k = 1; k <= 3; ++k) {
    const std::string material(1, static_cast<char>('a' + k - 1));
    results.Add("error", material, "theirs", 0.4);
    results.Add("error", material, "ours", 0.1 * k);
    results.Add("level", material, "theirs", 40.0);
    results.Add("level", material, "ours", 40.0 + k);
  }
  results.Add("error", "a", "partial", 0.5);
  results.Add("seconds", "b", "ours", 7.0);
  return results;
}

TEST(Results, HasATableForEachQuantity) {
  const std::string text = Some().Markdown();
  EXPECT_THAT(text, testing::ContainsRegex("### error\n\n\\| material +\\| theirs \\| ours +\\| "
                                           "partial"));
  EXPECT_THAT(text, testing::ContainsRegex("\\| a +\\| +0.40 \\| +0.10 \\| +0.50 "));
  EXPECT_THAT(text, testing::ContainsRegex("\\| c +\\| +0.40 \\| +0.30 \\| +- "));
  EXPECT_THAT(text, testing::ContainsRegex("\\*\\*median\\*\\* \\| +0.40 \\| +0.20 \\| +0.50 "));
  EXPECT_THAT(text, testing::ContainsRegex("### seconds\n\n\\| material +\\| ours"));
  EXPECT_THAT(text, Not(HasSubstr("absent")));
}

TEST(Results, ComparesOursWithEachOther) {
  const std::string text = Some().Markdown();
  EXPECT_THAT(text, HasSubstr("- ours over theirs: median 0.500, from 0.250 to 0.750 (3 "));
  EXPECT_THAT(text, HasSubstr("- ours over partial: median 0.200, from 0.200 to 0.200 (1 "));
  EXPECT_THAT(text, HasSubstr("- ours less theirs: median 2.00, from 1.00 to 3.00 (3 "));
  EXPECT_THAT(text, Not(HasSubstr("over ours")));
}

TEST(Results, KnowsItsValues) {
  Results results = Some();
  EXPECT_EQ(results.Value("level", "c", "ours"), 43.0);
  results.Add("level", "c", "ours", 44.0);
  EXPECT_EQ(results.Value("level", "c", "ours"), 44.0);
  EXPECT_TRUE(std::isnan(results.Value("level", "d", "ours")));
  EXPECT_TRUE(std::isnan(results.Value("absent", "c", "ours")));
}

}  // namespace
}  // namespace pbnbrdf
