#include "base/file_memo.h"

#include <chrono>
#include <filesystem>
#include <thread>
#include <vector>

#include "pbnbrdf/base/files.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

class FileMemoTest : public testing::Test {
 protected:
  std::string Get(const std::string& path) {
    return *memo_.Get(path, [&](const std::string& file) {
      ++reads_;
      return ReadFile(file, 100);
    });
  }

  const TemporaryFolder folder_;
  FileMemo<std::string> memo_;
  int reads_ = 0;
};

TEST_F(FileMemoTest, AFileIsReadOnceAndAgainWhenItHasChanged) {
  const std::string path = folder_ / "a";
  WriteFile(path, "one");
  EXPECT_EQ(Get(path), "one");
  EXPECT_EQ(Get(path), "one");
  EXPECT_EQ(reads_, 1);
  WriteFile(path, "three");
  EXPECT_EQ(Get(path), "three");
  // Of the same size, and later.
  WriteFile(path, "seven");
  std::filesystem::last_write_time(
      path, std::filesystem::last_write_time(path) + std::chrono::seconds(1));
  EXPECT_EQ(Get(path), "seven");
  EXPECT_EQ(reads_, 3);
}

TEST_F(FileMemoTest, OnlyTheLastFileIsKept) {
  for (const char* name : {"a", "b"}) WriteFile(folder_ / name, name);
  for (const char* name : {"a", "b", "a"}) EXPECT_EQ(Get(folder_ / name), name);
  EXPECT_EQ(reads_, 3);
}

TEST_F(FileMemoTest, ThreadsShareOneReading) {
  const std::string path = folder_ / "a";
  WriteFile(path, "one");
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int k = 0; k < 20; ++k) EXPECT_EQ(Get(path), "one");
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(reads_, 1);
}

TEST_F(FileMemoTest, WhatCannotBeReadIsAnErrorEachTime) {
  WriteFile(folder_ / "a", "one");
  EXPECT_EQ(Get(folder_ / "a"), "one");
  for (int k = 0; k < 2; ++k) {
    EXPECT_THAT(ErrorOf([&] { Get(folder_ / "missing"); }), HasSubstr("missing"));
  }
  EXPECT_EQ(Get(folder_ / "a"), "one");
}

}  // namespace
}  // namespace pbnbrdf
