#include "pbnbrdf/base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
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

// The size that a file of the kernel has isn't that of what it holds, as with one that shrinks while it is read.
TEST(Files, AFileThatShrinksIsRefused) {
  const std::string path = "/sys/kernel/mm/transparent_hugepage/enabled";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << path;
  EXPECT_THAT(ErrorOf([&] { ReadFile(path, 1 << 20); }), HasSubstr(" of 4096 bytes"));
}

// Interrupts system calls all the time, without asking for their restart, as Python does.
class Interruptions {
 public:
  Interruptions() {
    struct sigaction action = {};
    action.sa_handler = [](int) {};
    sigaction(SIGALRM, &action, &before_);
    const itimerval often = {{0, 200}, {0, 200}};
    setitimer(ITIMER_REAL, &often, nullptr);
  }
  ~Interruptions() {
    const itimerval never = {};
    setitimer(ITIMER_REAL, &never, nullptr);
    sigaction(SIGALRM, &before_, nullptr);
  }
  Interruptions(const Interruptions&) = delete;
  Interruptions& operator=(const Interruptions&) = delete;

 private:
  struct sigaction before_;
};

TEST(Files, AnInterruptedCallGoesOn) {
  TemporaryFolder folder;
  std::string bytes(3 << 20, 'x');
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = char(k * k >> 8);
  for (const char* name : {"a", "b", "c"}) {
    const std::string pipe = folder / name;
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int keeps_it_open = open(pipe.c_str(), O_RDWR);
    const Interruptions interruptions;
    std::thread writer([&] {
      WriteFile(pipe, bytes);
      close(keeps_it_open);
    });
    std::string found;
    const std::string error = ErrorOf([&] { found = ReadFile(pipe, bytes.size()); });
    writer.join();
    EXPECT_EQ(error, "");
    EXPECT_TRUE(found == bytes);
    WriteFile(folder / "file", bytes);
    EXPECT_TRUE(ReadFile(folder / "file", bytes.size()) == bytes);
  }
}

// The pipe's other end comes late, and is not interrupted itself.
TEST(Files, AnInterruptedReaderWaitsForItsWriter) {
  using std::chrono::milliseconds;
  TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    std::this_thread::sleep_for(milliseconds(20));
    std::ofstream out(pipe);
    std::this_thread::sleep_for(milliseconds(100));
    out << "here";
  });
  const Interruptions interruptions;
  std::string found;
  const std::string error = ErrorOf([&] { found = ReadFile(pipe, 10); });
  writer.join();
  EXPECT_EQ(error, "");
  EXPECT_EQ(found, "here");
}

// A pipe that is slow to take what comes, while signals do.
TEST(Files, StandardOutputIsWrittenThroughInterruptions) {
  const std::string bytes(1 << 20, 'x');
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  std::fflush(stdout);
  const int before = dup(1);
  dup2(ends[1], 1);
  close(ends[1]);
  std::size_t received = 0;
  std::thread reader([&] {
    char block[4096];
    for (ssize_t n; (n = read(ends[0], block, sizeof(block))) != 0;) {
      if (n > 0) received += std::size_t(n);
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  });
  std::string error;
  {
    const Interruptions interruptions;
    error = ErrorOf([&] { WriteFile("-", bytes); });
  }
  dup2(before, 1);
  close(before);
  reader.join();
  EXPECT_EQ(error, "");
  EXPECT_EQ(received, bytes.size());
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
