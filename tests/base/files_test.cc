#include "pbnbrdf/base/files.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <thread>

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

TEST(Files, WhatIsWrittenIsRead) {
  TemporaryFolder folder;
  const std::string bytes("a\0b\n\xff", 5);
  WriteFile(folder / "x", bytes);
  EXPECT_EQ(ReadFile(folder / "x", 5), bytes);
  WriteFile(folder / "x", "");
  EXPECT_EQ(ReadFile(folder / "x", 5), "");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Files, ErrorsNameTheFile) {
  TemporaryFolder folder;
  EXPECT_THAT(ErrorOf([&] { ReadFile(folder / "none", 5); }), HasSubstr("none: no such file"));
  EXPECT_THAT(ErrorOf([&] { ReadFile(folder / "", 5); }), HasSubstr("not a regular file"));
  WriteBytes(folder / "big", "123456");
  EXPECT_THAT(ErrorOf([&] { ReadFile(folder / "big", 5); }),
              HasSubstr("big: 6 bytes, at most 5 were expected"));
}

TEST(Files, APipeIsReadOnceAndKept) {
  TemporaryFolder folder;
  const std::string pipe = folder / "pipe", bytes(100000, 'x');
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { WriteBytes(pipe, bytes); });
  EXPECT_EQ(ReadStart(pipe, 3), "xxx");
  writer.join();
  EXPECT_EQ(FileSize(pipe), bytes.size());
  EXPECT_EQ(ReadFile(pipe, bytes.size()), bytes);
  EXPECT_THAT(ErrorOf([&] { ReadFile(pipe, 5); }), HasSubstr("100000 bytes, at most 5"));
  EXPECT_THAT(ErrorOf([&] { ReadFile("/dev/null", 5); }), HasSubstr("/dev/null: cannot read"));
  EXPECT_THAT(ErrorOf([&] { ReadStart("/dev/zero", 5); }), HasSubstr("a pipe of more than"));
}

TEST(Files, AFailedWriteLeavesNothing) {
  TemporaryFolder folder;
  EXPECT_THAT(ErrorOf([&] { WriteFile(folder / "no/such/folder/x", "1"); }),
              HasSubstr("x: cannot write"));
  std::filesystem::create_directory(folder / "occupied");
  WriteBytes(folder / "occupied/file", "1");
  EXPECT_THAT(ErrorOf([&] { WriteFile(folder / "occupied", "1"); }), HasSubstr("cannot write"));
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Files, SeveralFilesAreReplacedTogetherOrNot) {
  TemporaryFolder folder;
  WriteFiles({{folder / "a", "1"}, {folder / "b", "2"}});
  EXPECT_EQ(ReadFile(folder / "a", 9), "1");
  EXPECT_EQ(ReadFile(folder / "b", 9), "2");
  EXPECT_THAT(ErrorOf([&] {
                WriteFiles({{folder / "a", "3"}, {folder / "no/b", "4"}});
              }),
              HasSubstr("no/b: cannot write: no folder"));
  const std::string long_name(300, 'x');  // found out when it is renamed only
  std::filesystem::create_directory(folder / "c");
  mkfifo((folder / "pipe").c_str(), 0600);
  EXPECT_THAT(ErrorOf([&] {
                WriteFiles({{folder / "a", "3"}, {folder / "c", "4"}});
              }),
              HasSubstr("c: cannot write: is a folder"));
  EXPECT_THAT(ErrorOf([&] {
                WriteFiles({{folder / "a", "3"}, {folder / "pipe", "4"}});
              }),
              HasSubstr("pipe: cannot write: not a regular file"));
  EXPECT_EQ(ReadFile(folder / "a", 9), "1");
  EXPECT_THAT(ErrorOf([&] {
                WriteFiles({{folder / long_name, "3"}, {folder / "a", "4"}});
              }),
              HasSubstr("cannot write: File name too long"));
  EXPECT_EQ(ReadFile(folder / "a", 9), "1");
  EXPECT_EQ(folder.file_count(), 4u);
}

TEST(Files, TheModeOfAFileThatIsReplacedStays) {
  const TemporaryFolder folder;
  const std::string path = folder / "a";
  WriteFile(path, "old");
  const auto mine = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
  std::filesystem::permissions(path, mine);
  WriteFile(path, "new");
  EXPECT_EQ(std::filesystem::status(path).permissions(), mine);
  WriteFiles({{path, "newer"}, {folder / "b", "other"}});
  EXPECT_EQ(std::filesystem::status(path).permissions(), mine);
  EXPECT_EQ(ReadFile(path, 100), "newer");
}

TEST(Files, APipeStaysOne) {
  TemporaryFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  WriteFile(path, "bytes");
  char buffer[16];
  EXPECT_EQ(read(reader, buffer, sizeof(buffer)), 5);
  close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST(Files, CheckWritableForeseesFailure) {
  TemporaryFolder folder;
  EXPECT_EQ(ErrorOf([&] { CheckWritable(folder / "x"); }), "");
  EXPECT_THAT(ErrorOf([&] { CheckWritable(folder / "none/x"); }), HasSubstr("no folder"));
  EXPECT_THAT(ErrorOf([&] { CheckWritable(folder / ""); }), HasSubstr("is a folder"));
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace pbnbrdf
