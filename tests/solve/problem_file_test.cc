// Problem files: those that ship, their records, and what is wrong with others.
#include "pbnbrdf/solve/problem_file.h"

#include <filesystem>
#include <set>

#include "pbnbrdf/base/error.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

std::string ReadError(const std::string& lines) {
  const TemporaryFolder folder;
  WriteBytes(folder / "x.flags", lines);
  try {
    ReadProblem(folder / "x.flags");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ProblemFile, EveryShippedProblemIsReadAndRecordedExactly) {
  const TemporaryFolder folder;
  std::set<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(PBNBRDF_PROBLEMS)) {
    if (entry.path().extension() != ".flags") continue;
    const FitSetup setup = ReadProblem(entry.path());
    WriteProblem(folder / "again.flags", setup);
    EXPECT_EQ(ProblemText(ReadProblem(folder / "again.flags")), ProblemText(setup)) << entry.path();
    texts.insert(ProblemText(setup));
  }
  EXPECT_EQ(texts.size(), 8u);  // no two of them are the same
}

TEST(ProblemFile, PublishedRecipesSayWhatWasPublished) {
  const std::string folder = PBNBRDF_PROBLEMS;
  const auto [problem, options] = ReadProblem(folder + "/pbnbrdf_adam.flags");
  EXPECT_EQ(problem.network.encoding, Encoding::kReciprocal);
  EXPECT_EQ(problem.network.initialization, Initialization::kNbrdf);
  EXPECT_EQ(problem.terms.Weight("chromaticity"), 1.0);
  EXPECT_EQ(problem.terms.EnergyWeight(), 1.0);
  EXPECT_EQ(problem.sampling.samples, 640000u);
  EXPECT_EQ(options.solver, "adam");
  EXPECT_EQ(options.schedule.max_iterations, 100);
  EXPECT_FALSE(options.certify_energy);
  EXPECT_EQ(ReadProblem(folder + "/pbnbrdf.flags").problem.terms.Weight("chromaticity"), 0.1);
  EXPECT_EQ(ReadProblem(folder + "/nbrdf_adam.flags").problem.terms.weights.size(), 1u);
}

TEST(ProblemFile, AnEmptyFileIsTheDefaultProblem) {
  const TemporaryFolder folder;
  WriteBytes(folder / "x.flags", "# nothing\n");
  EXPECT_EQ(ProblemText(ReadProblem(folder / "x.flags")), ProblemText({}));
}

TEST(ProblemFile, TermsAreNamesWithOrWithoutWeights) {
  const TemporaryFolder folder;
  WriteBytes(folder / "x.flags", "--terms=log:2,chromaticity,energy:0.25\n");
  const FitSetup setup = ReadProblem(folder / "x.flags");
  EXPECT_EQ(setup.problem.terms.Weight("log"), 2.0);
  EXPECT_EQ(setup.problem.terms.Weight("chromaticity"), 0.1);
  EXPECT_EQ(setup.problem.terms.EnergyWeight(), 0.25);
  EXPECT_THAT(ProblemText(setup), HasSubstr("--terms=log:2,chromaticity,energy:0.25\n"));
}

TEST(ProblemFile, MistakesAreNamedWithTheFile) {
  EXPECT_THAT(ReadError("--los=l2"),
              HasSubstr("x.flags: --los is not a flag; did you mean --loss?"));
  EXPECT_THAT(ReadError("--terms=log,colour"),
              HasSubstr("x.flags: --terms=colour is not one of log | chromaticity | energy"));
  EXPECT_THAT(ReadError("--terms=log:1:2"), HasSubstr("terms: 'log:1:2' must be NAME or NAME:WEI"));
  EXPECT_THAT(ReadError("--terms=log:x"), HasSubstr("terms: 'x' is not a finite number"));
  EXPECT_THAT(ReadError("--terms=log,log"), HasSubstr("terms: log is there twice"));
  EXPECT_THAT(ReadError("--terms=energy"), HasSubstr("terms: log or chromaticity must be among"));
  EXPECT_THAT(ReadError("--growth=1"), HasSubstr("growth = 1; must be finite and > 1"));
  EXPECT_THAT(ReadError("--scene_floor=0.5"), HasSubstr("--scene_floor is not a flag"));
}

}  // namespace
}  // namespace pbnbrdf
