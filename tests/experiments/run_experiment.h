// run_experiment.h: runs a program of experiments/ and reads what it wrote.
#pragma once

#include <string>
#include <vector>

#include "base/text.h"
#include "pbnbrdf/base/files.h"
#include "process.h"
#include "test_util.h"

namespace pbnbrdf {

inline std::string Read(const std::string& path) { return ReadFile(path, 1 << 24); }

// The rows of a CSV below its header, which must be `header`.
inline std::vector<std::vector<std::string>> ReadRows(const std::string& path,
                                                      const std::string& header) {
  std::vector<std::vector<std::string>> rows;
  const std::vector<std::string> lines = Split(Read(path), '\n');
  EXPECT_EQ(lines[0], header);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    rows.push_back(Split(lines[i], ','));
    EXPECT_EQ(rows.back().size(), Split(header, ',').size()) << lines[i];
  }
  return rows;
}

inline void ExpectFigure(const std::string& path) {
  if (RunProgram({"gnuplot", "--version"}).status != 0) return;
  EXPECT_THAT(Read(path), testing::HasSubstr("</svg>"));
}

inline ProgramResult RunIn(const TemporaryFolder& folder, const std::string& program,
                           std::vector<std::string> flags) {
  flags.insert(flags.begin(),
               {PBNBRDF_EXPERIMENTS "/" + program, "--out_dir=" + (folder / "results")});
  return RunProgram(flags);
}

}  // namespace pbnbrdf
