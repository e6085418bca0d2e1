// cli_fixture.h: the program as a user runs it.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "pbnbrdf/base/files.h"
#include "test_util.h"

namespace pbnbrdf {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct Result {
  int status;
  std::string out, err;
};

class Cli : public testing::Test {
 protected:
  // Runs the shell's "pbnbrdf <arguments>".
  Result Run(const std::string& arguments) const {
    const std::string command = StrCat(PBNBRDF_PROGRAM, " ", arguments, " 2> ", folder_ / "stderr");
    FILE* pipe = popen(command.c_str(), "r");
    std::string out;
    std::array<char, 4096> buffer;
    while (std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
      out.append(buffer.data(), n);
    const int status = pclose(pipe);
    EXPECT_TRUE(WIFEXITED(status)) << "crashed: " << arguments;
    return {WEXITSTATUS(status), out, ReadFile(folder_ / "stderr", 1 << 20)};
  }

  // That it fails as promised: the status, one line on stderr, nothing left behind.
  void ExpectError(const std::string& arguments, int status, const std::string& message) const {
    const Result result = Run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    EXPECT_THAT(result.err, StartsWith("pbnbrdf: "));
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << arguments;
  }

  std::string Path(const std::string& name) const { return folder_ / name; }

  // Flags of a fit that takes a moment.
  const std::string kQuick = " --samples=500 --max_iterations=4 --hidden=5 --terms=log ";

  TemporaryFolder folder_;
};

}  // namespace pbnbrdf
