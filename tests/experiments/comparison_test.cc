#include "comparison.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::Not;

FitRecord Record(const std::string& material, int seed,
                 std::vector<std::pair<double, double>> curve, double error) {
  FitRecord record{material, "lm", "21-21", seed, {}, curve.back().first, error};
  for (const auto& [seconds, heldout_error] : curve) {
    FitProgress progress;
    progress.seconds = seconds;
    progress.heldout_error = heldout_error;
    record.trace.push_back(progress);
  }
  return record;
}

TEST(Compare, MeasuresTheWholeFitIfItEndsFirst) {
  const Versus versus =
      Compare(Record("gold", 1, {{0.5, 0.02}, {2.0, 0.001}}, 0.0011), {8.0, 0.03, 0.02, {}, {}});
  EXPECT_EQ(versus.seconds_to_error, 0.5);
  EXPECT_EQ(versus.times_as_fast, 16.0);
  EXPECT_EQ(versus.error_then, 0.0011);
  EXPECT_NEAR(versus.times_as_accurate, 0.02 / 0.0011, 1e-12);
}

TEST(Compare, TakesTheTraceWhereTheFitGoesOn) {
  const Versus versus = Compare(Record("gold", 1, {{0.5, 0.02}, {2.0, 0.001}}, 0.0011),
                                {1.0, 0.0001, 0.0001, {}, {}});
  EXPECT_EQ(versus.seconds_to_error, INFINITY);
  EXPECT_EQ(versus.times_as_fast, 0.0);
  EXPECT_EQ(versus.error_then, 0.02);
}

TEST(ComparisonMarkdown, HasMediansOfSeedsAndTheWorstFit) {
  // Against a peer of 8 s: to its error in 1, 2 and 4 s with one material, in 4 s with the other.
  const std::vector<FitRecord> fits = {
      Record("gold", 1, {{1.0, 0.01}}, 0.01), Record("gold", 2, {{2.0, 0.01}}, 0.01),
      Record("gold", 3, {{4.0, 0.01}}, 0.01), Record("tin", 1, {{4.0, 0.005}}, 0.005)};
  const PeerRecords peers = {{"gold", {8.0, 0.01, 0.01, {}, {}}},
                             {"tin", {8.0, 0.01, 0.01, {}, {}}}};
  const std::string text = ComparisonMarkdown(fits, peers);
  EXPECT_THAT(text, HasSubstr("### lm, 21-21 hidden units"));
  EXPECT_THAT(text, testing::ContainsRegex("gold +\\|.*\\| +4.00 \\| +0.0100 \\| +1.00 \\|"));
  EXPECT_THAT(text, testing::ContainsRegex("median.*\\| +3.00 \\| +0.00750 \\| +1.50 \\|"));
  EXPECT_THAT(text, testing::ContainsRegex("worst of.*\\| +2.00 \\| +0.0100 \\| +1.00 \\|"));
  EXPECT_THAT(text, testing::ContainsRegex(
                        "21-21 +\\| lm +\\|.*\\| +3.00 \\| +2.00 \\| +1.50 \\| +1.00 \\|"));
}

TEST(ComparisonMarkdown, WithoutThePeerLeavesItsColumnsOut) {
  const std::string text = ComparisonMarkdown({Record("gold", 1, {{1.0, 0.01}}, 0.02)}, {});
  EXPECT_THAT(text, HasSubstr("gold"));
  EXPECT_THAT(text, HasSubstr("0.0200"));
  EXPECT_THAT(text, Not(HasSubstr("peer")));
}

TEST(ComparisonMarkdown, AMaterialThatThePeerFailedAtHasNoRatios) {
  const std::vector<FitRecord> fits = {Record("gold", 1, {{1.0, 0.01}}, 0.01),
                                       Record("tin", 1, {{1.0, 0.01}}, 0.01)};
  const std::string text = ComparisonMarkdown(fits, {{"gold", {2.0, 0.01, 0.01, {}, {}}}});
  EXPECT_THAT(text, testing::ContainsRegex("tin +\\|[^|]*\\|[^|]*\\| +- \\| +- \\|"));
  EXPECT_THAT(text, testing::ContainsRegex("median.*\\| +2.00 \\|"));
}

TEST(ComparisonFigure, HasAPanelForEachNetwork) {
  std::vector<FitRecord> fits = {Record("gold", 1, {{1.0, 0.01}, {2.0, 0.001}}, 0.001),
                                 Record("gold", 1, {{1.0, 0.02}}, 0.02)};
  fits[1].hidden = "8-8";
  const PeerRecords peers = {{"gold", {8.0, 0.01, 0.01, fits[0].trace, {}}}};
  const Figure figure = ComparisonFigure(fits, peers);
  ASSERT_EQ(figure.panels.size(), 2u);
  ASSERT_EQ(figure.panels[1].series.size(), 2u);
  EXPECT_EQ(figure.panels[1].series[0].label, "lm");
  EXPECT_EQ(figure.panels[1].series[0].points.back().second, 0.02);
  EXPECT_EQ(figure.panels[1].series[1].label, "peer, 21-21");
}

}  // namespace
}  // namespace pbnbrdf
