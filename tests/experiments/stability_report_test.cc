#include "stability_report.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

const std::vector<StabilityFactor> kFactors = {
    {"material", {"a", "b"}},  {"stress", {"none"}},     {"solver", {"adam"}},
    {"loss", {"l2"}},          {"terms", {"log"}},       {"encoding", {"merl"}},
    {"precision", {"double"}}, {"activation", {"relu"}}, {"initialization", {"nbrdf"}}};

StabilityRecord Record(int run, const std::string& material, const std::string& outcome,
                       double error) {
  StabilityRecord record;
  record.run = run;
  record.levels = {material, "none", "adam", "l2", "log", "merl", "double", "relu", "nbrdf"};
  record.outcome = outcome;
  record.error = error;
  record.message = StrCat("cost ", error, " after 12 steps, that's 1.5e-07");
  return record;
}

TEST(StabilityRecord, ComesBackFromItsCells) {
  StabilityRecord record = Record(7, "a", "error", std::nan(""));
  record.restarts = 2;
  record.gradient = {1e-9, 8, 1};
  const StabilityRecord back = ParseRecord(RecordCells(record), kFactors.size());
  EXPECT_EQ(back.run, 7);
  EXPECT_EQ(back.levels, record.levels);
  EXPECT_EQ(back.outcome, "error");
  EXPECT_EQ(back.message, "cost nan after 12 steps; that's 1.5e-07");  // a cell without quotes
  EXPECT_TRUE(std::isnan(back.error));
  EXPECT_EQ(back.restarts, 2);
  EXPECT_EQ(back.gradient.worst_error, 1e-9);
  EXPECT_EQ(back.gradient.resolved, 8);
  EXPECT_EQ(RecordCells(back).size(),
            RecordColumns({"a", "b", "c", "d", "e", "f", "g", "h", "i"}).size());
  EXPECT_NE(ErrorOf([] { ParseRecord({"1", "a"}, 4); }), "");
}

TEST(StabilityReport, MessageKindsHaveNoNumbers) {
  EXPECT_EQ(MessageKind("8 of 1000 angles; 1.5e-07 <= 2e+12 * cost 3."),
            "# of # angles; # <= # * cost #.");
}

TEST(StabilityReport, ErrorsAreComparedWithinTheirGroup) {
  const std::vector<StabilityRecord> records = {
      Record(0, "a", "ok", 0.1), Record(1, "a", "ok", 0.2), Record(2, "a", "ok", 1.0),
      Record(3, "b", "ok", 3.0), Record(4, "b", "error", 9.0)};
  const std::vector<double> ratios = ErrorRatios(kFactors, records);
  EXPECT_DOUBLE_EQ(ratios[0], 0.5);
  EXPECT_DOUBLE_EQ(ratios[2], 5.0);
  EXPECT_DOUBLE_EQ(ratios[3], 1.0);
  EXPECT_TRUE(std::isnan(ratios[4]));
  EXPECT_DOUBLE_EQ(ErrorRatios(kFactors, {Record(0, "a", "ok", 1e-9)})[0], 1e-5);  // kMinMedian
}

TEST(StabilityReport, CountsOutcomesOfEachLevel) {
  StabilityRecord crash = Record(2, "b", "crash", std::nan(""));
  crash.message = "process ended with status 139";
  const std::string text = StabilityMarkdown(
      kFactors, {Record(0, "a", "ok", 0.1), Record(1, "b", "error", std::nan("")), crash});
  EXPECT_THAT(text, HasSubstr("### By material"));
  EXPECT_THAT(text, HasSubstr("| a        |    1 |   1 |      0 |          0 |       0 |"));
  EXPECT_THAT(text, HasSubstr("| b        |    2 |   0 |      1 |          0 |       1 |"));
  EXPECT_THAT(text, HasSubstr("cost nan after # steps, that's #"));
  EXPECT_THAT(text, HasSubstr("process ended with status #"));
}

}  // namespace
}  // namespace pbnbrdf
