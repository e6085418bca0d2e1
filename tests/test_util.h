// test_util.h: what several tests need.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "base/pi.h"
#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

// A file in the folder of reference data; skips the test if it is absent.
#define PBNBRDF_REFERENCE_FILE(variable, name)                                     \
  const std::string variable = std::string(PBNBRDF_REFERENCE_DATA) + "/" + (name); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "needs reference data: " << variable

// A folder that goes when the test ends.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            StrCat("pbnbrdf_", test->test_suite_name(), "_", test->name(), "_", getpid());
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline void WriteBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// What the function throws as Error; "" if it doesn't.
template <typename Function>
std::string ErrorOf(Function function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Uniform numbers in [low, high).
inline std::vector<double> RandomNumbers(std::size_t count, double low, double high,
                                         unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = uniform(random);
  return numbers;
}

// The rows of a CSV file but its header.
inline std::vector<std::vector<std::string>> ReadCsvRows(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) rows.push_back(Split(line, ','));
  return rows;
}

}  // namespace pbnbrdf
