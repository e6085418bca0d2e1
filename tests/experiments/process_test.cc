#include "process.h"

#include <cstdlib>

#include "test_util.h"

namespace pbnbrdf {
namespace {

TEST(RunProgram, ReturnsOutputAndStatus) {
  const ProgramResult result = RunProgram({"sh", "-c", "echo one; echo two >&2; exit 3"});
  EXPECT_EQ(result.output, "one\n");
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(RunProgram({"no-program-of-this-name"}).status, 127);
}

TEST(RunProgram, TakesVariablesFromTheEnvironment) {
  setenv("PBNBRDF_KEPT", "kept", 1);
  setenv("PBNBRDF_DROPPED", "dropped", 1);
  const std::string script = "echo $PBNBRDF_KEPT$PBNBRDF_DROPPED";
  EXPECT_EQ(RunProgram({"sh", "-c", script}, {"PBNBRDF_DROPPED"}).output, "kept\n");
}

TEST(RunInChild, ReturnsNumbersAndHasItsOwnMemory) {
  constexpr std::size_t kBytes = 64 << 20;
  const std::vector<double> result = RunInChild([] {
    const std::vector<char> filled(kBytes, 'x');
    return std::vector<double>{static_cast<double>(filled[kBytes / 2]),
                               static_cast<double>(PeakMemory())};
  });
  ASSERT_EQ(result.size(), 2u);
  EXPECT_EQ(result[0], 'x');
  EXPECT_GE(result[1], kBytes);
  EXPECT_LT(ResidentMemory(), kBytes);
}

TEST(RunInChild, ThrowsIfTheChildFails) {
  const auto fail = [] { RunInChild([]() -> std::vector<double> { throw Error("no data"); }); };
  EXPECT_EQ(ErrorOf(fail), "a measurement in a process of its own ended with status 1");
}

TEST(MedianSeconds, RunsAtLeastOnceAndForSoLong) {
  int runs = 0;
  EXPECT_GE(MedianSeconds(0.0, [&] { ++runs; }), 0.0);
  EXPECT_EQ(runs, 1);
  MedianSeconds(0.001, [&] { ++runs; });
  EXPECT_GT(runs, 2);
}

}  // namespace
}  // namespace pbnbrdf
