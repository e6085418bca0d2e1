#include "figure.h"

#include "pbnbrdf/base/files.h"
#include "process.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(SpreadApart, LeavesWhatIsFarApart) {
  EXPECT_THAT(SpreadApart({0.9, 0.1, 0.5}, 0.1), ElementsAre(0.9, 0.1, 0.5));
}

TEST(SpreadApart, KeepsTheOrderAndTheGapWithinTheRange) {
  const std::vector<double> spread = SpreadApart({0.99, 0.98, 1.0}, 0.1);
  EXPECT_NEAR(spread[1], 0.8, 1e-12);
  EXPECT_NEAR(spread[0], 0.9, 1e-12);
  EXPECT_NEAR(spread[2], 1.0, 1e-12);
  EXPECT_TRUE(SpreadApart({}, 0.1).empty());
}

Figure OneLine(const std::string& label) {
  return {{{"It's a title", "Seconds", "Error", {{label, {{0.1, 1.0}, {10.0, 0.001}}}}}}};
}

TEST(GnuplotScript, HasTheDataAndQuotesTexts) {
  const std::string script = GnuplotScript(OneLine("lm"), "out.svg");
  EXPECT_THAT(script, HasSubstr("set title 'It''s a title'"));
  EXPECT_THAT(script, HasSubstr("0.1 1\n10 0.001\n"));
  EXPECT_THAT(script, HasSubstr("set output 'out.svg'"));
  EXPECT_THAT(script, HasSubstr("'lm' at graph"));
}

TEST(GnuplotScript, LeavesOutPanelsAndLinesWithoutPoints) {
  Figure figure = OneLine("lm");
  figure.panels[0].series.push_back({"empty", {}});
  figure.panels.push_back({"nothing", "x", "y", {}});
  const std::string script = GnuplotScript(figure, "out.svg");
  EXPECT_THAT(script, Not(HasSubstr("'empty'")));
  EXPECT_THAT(script, Not(HasSubstr("nothing")));
}

TEST(DrawFigure, WithoutPanelsThereIsNone) {
  const TemporaryFolder folder;
  EXPECT_EQ(DrawFigure({}, folder / "f.svg"), "no figure: there is nothing to draw");
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(DrawFigure, DrawsTheLabels) {
  const TemporaryFolder folder;
  const std::string problem = DrawFigure(OneLine("ceres_lm"), folder / "f.svg");
  if (RunProgram({"gnuplot", "--version"}).status != 0) {
    EXPECT_THAT(problem, HasSubstr("gnuplot is not installed"));
    GTEST_SKIP() << "needs gnuplot";
  }
  EXPECT_EQ(problem, "");
  const std::string svg = ReadFile(folder / "f.svg", 1 << 20);
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, HasSubstr("ceres_lm"));
}

}  // namespace
}  // namespace pbnbrdf
