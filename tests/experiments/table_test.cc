#include "table.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

TEST(Table, MarkdownAlignsNumbersToTheRight) {
  Table table({"name", "x"});
  table.Add({"gold", "1.5"});
  table.Add({"tin", "-"});
  EXPECT_EQ(table.Markdown(),
            "| name |   x |\n"
            "| ---- | --: |\n"
            "| gold | 1.5 |\n"
            "| tin  |   - |\n");
}

TEST(Table, CsvQuotesWhatNeedsIt) {
  Table table({"name", "x"});
  table.Add({"a,b", "say \"x\""});
  EXPECT_EQ(table.Csv(), "name,x\n\"a,b\",\"say \"\"x\"\"\"\n");
}

TEST(Table, RejectsARowOfAnotherLength) {
  Table table({"name", "x"});
  EXPECT_EQ(ErrorOf([&] { table.Add({"gold"}); }), "a row of 1 cells in a table of 2 columns");
}

TEST(Significant, KeepsSoManyDigits) {
  EXPECT_EQ(Significant(0.00012345, 3), "0.000123");
  EXPECT_EQ(Significant(12.345, 3), "12.3");
  EXPECT_EQ(Significant(12345.0, 3), "12345");
  EXPECT_EQ(Significant(0.0, 3), "0.00");
  EXPECT_EQ(Significant(INFINITY, 3), "-");
  EXPECT_EQ(Significant(NAN, 3), "-");
}

}  // namespace
}  // namespace pbnbrdf
