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

}  // namespace
}  // namespace pbnbrdf
