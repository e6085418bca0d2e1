#include "pbnbrdf/base/files.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartialEnd = ".part";
constexpr std::streamsize kPipeBlock = 1 << 16;
// More than files of most formats have; /dev/zero has no end.
constexpr std::size_t kMaxPipeBytes = std::size_t{1} << 28;

// How the names of files begin that aren't whole yet; the number of their process follows.
std::string PartialStart() {
  char host[256] = {};
  gethostname(host, sizeof(host) - 1);
  return StrCat(".pbnbrdf.", host, ".");
}

std::string Reason() { return errno != 0 ? std::strerror(errno) : "unknown error"; }

// Opens a stream. Waiting for a pipe's other end may be interrupted by a signal, and goes on.
template <typename Stream>
Stream Open(const fs::path& path, std::ios::openmode mode) {
  Stream stream;
  do {
    errno = 0;
    stream.clear();
    stream.open(path, mode | std::ios::binary);
  } while (!stream && errno == EINTR);
  return stream;
}

// Behind what was printed before. A signal that interrupts it doesn't end it.
void WriteStandardOutput(std::string_view content) {
  errno = 0;
  while (std::fflush(stdout) != 0 && errno == EINTR) std::clearerr(stdout);
  // Where an earlier write failed, its reason is gone.
  if (std::ferror(stdout) != 0) {
    Fail("standard output: cannot write", errno != 0 ? ": " + Reason() : " all of it");
  }
  while (!content.empty()) {
    const ssize_t written = write(STDOUT_FILENO, content.data(), content.size());
    if (written >= 0) {
      content.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      Fail("standard output: cannot write: ", Reason());
    }
  }
}

// What a pipe or a device holds, read once and kept: its bytes don't come again.
const std::string& PipeBytes(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, std::string> all;
  const std::lock_guard lock(mutex);
  const auto known = all.find(path);
  if (known != all.end()) return known->second;
  auto in = Open<std::ifstream>(path, std::ios::in);
  std::string bytes, block(kPipeBlock, '\0');
  while (in.read(block.data(), kPipeBlock), in.gcount() > 0) {
    bytes.append(block, 0, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > kMaxPipeBytes) Fail(path, ": a pipe of more than ", kMaxPipeBytes, " bytes");
  }
  if (in.bad() || bytes.empty()) Fail(path, ": cannot read: no data in this pipe or device");
  return all.emplace(path, std::move(bytes)).first->second;
}

bool IsPipe(const std::string& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  return fs::is_fifo(status) || fs::is_character_file(status);
}

// Exactly `size` bytes from the file's beginning.
std::string ReadBytes(const std::string& path, std::uintmax_t size) {
  if (IsPipe(path)) return PipeBytes(path).substr(0, size);
  auto in = Open<std::ifstream>(path, std::ios::in);
  if (!in) Fail(path, ": cannot read: ", Reason());
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) {
    Fail(path, ": cannot read: got ", in.gcount(), " of ", size, " bytes");
  }
  return bytes;
}

// False, with errno set, if not all of it could be written.
bool WriteBytes(const fs::path& path, std::string_view content) {
  auto out = Open<std::ofstream>(path, std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  return static_cast<bool>(out);
}

// While it lives, signals that would end the program wait.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t waiting;
    sigemptyset(&waiting);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&waiting, signal);
    pthread_sigmask(SIG_BLOCK, &waiting, &before_);
  }
  ~SignalsWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_;
};

// What is to become the file at `path`, under another name in the same folder; removed if that
// doesn't come about.
class PartialFile {
 public:
  explicit PartialFile(const std::string& path) : path_(path) {
    static std::atomic<std::size_t> count = 0;  // tells those of one process apart
    std::error_code code;
    // A link stays one: what it points to is replaced.
    target_ = fs::exists(path, code) ? fs::canonical(path, code) : fs::path(path);
    partial_ = target_.parent_path() / StrCat(PartialStart(), getpid(), ".", count++, kPartialEnd);
  }
  ~PartialFile() {
    std::error_code code;
    if (!renamed_) fs::remove(partial_, code);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  // With the mode of the file that is replaced.
  void Write(std::string_view content) {
    std::error_code code;
    const fs::file_status replaced = fs::status(target_, code);
    if (!WriteBytes(partial_, "")) Fail(path_, ": cannot write: ", Reason());
    if (fs::exists(replaced)) fs::permissions(partial_, replaced.permissions(), code);
    if (!WriteBytes(partial_, content)) Fail(path_, ": cannot write: ", Reason());
  }

  void Rename() {
    errno = 0;
    renamed_ = std::rename(partial_.c_str(), target_.c_str()) == 0;
    if (!renamed_) Fail(path_, ": cannot write: ", Reason());
  }

 private:
  const std::string path_;
  fs::path target_, partial_;
  bool renamed_ = false;
};

}  // namespace

std::uintmax_t FileSize(const std::string& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) Fail(path, ": no such file");
  if (IsPipe(path)) return PipeBytes(path).size();
  if (!fs::is_regular_file(status)) Fail(path, ": not a regular file");
  const std::uintmax_t size = fs::file_size(path, code);
  if (code) Fail(path, ": cannot read: ", code.message());
  return size;
}

std::string ReadFile(const std::string& path, std::uintmax_t limit) {
  const std::uintmax_t size = FileSize(path);
  if (size > limit) Fail(path, ": ", size, " bytes, at most ", limit, " were expected");
  return ReadBytes(path, size);
}

std::string ReadStart(const std::string& path, std::size_t most) {
  return ReadBytes(path, std::min<std::uintmax_t>(FileSize(path), most));
}

void WriteFile(const std::string& path, std::string_view content) {
  if (path == "-") return WriteStandardOutput(content);
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    // A device or a pipe: nothing to rename over.
    if (!WriteBytes(path, content)) Fail(path, ": cannot write: ", Reason());
    return;
  }
  const SignalsWait until_renamed;
  PartialFile file(path);
  file.Write(content);
  file.Rename();
}

void WriteFiles(const std::vector<FileContent>& files) {
  if (files.size() == 1) return WriteFile(files[0].path, files[0].content);
  for (const FileContent& file : files) {
    CheckWritable(file.path);
    if (file.path != "-" && fs::exists(file.path) && !fs::is_regular_file(file.path)) {
      Fail(file.path, ": cannot write: not a regular file");
    }
  }
  const SignalsWait until_renamed;
  std::vector<std::unique_ptr<PartialFile>> partials;
  for (const FileContent& file : files) {
    if (file.path == "-") continue;
    partials.push_back(std::make_unique<PartialFile>(file.path));
    partials.back()->Write(file.content);
  }
  for (const auto& partial : partials) partial->Rename();
  for (const FileContent& file : files) {
    if (file.path == "-") WriteStandardOutput(file.content);
  }
}

void CheckWritable(const std::string& path) {
  if (path == "-") return;
  if (path.empty()) Fail("an output file's name is empty");
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::none) Fail(path, ": cannot write: ", code.message());
  if (fs::is_directory(status)) Fail(path, ": cannot write: is a folder");
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder, code)) {
    Fail(path, ": cannot write: no folder ", folder.string());
  }
  errno = 0;
  if (access(folder.c_str(), W_OK) != 0) Fail(path, ": cannot write: ", Reason());
}

void RemovePartialFiles(const std::string& folder) {
  std::error_code code;
  const std::string start = PartialStart();
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(start) || !name.ends_with(kPartialEnd)) continue;
    const pid_t process = std::atoi(name.c_str() + start.size());
    const bool is_gone = process > 0 && kill(process, 0) != 0 && errno == ESRCH;
    if (is_gone) fs::remove(entry.path(), code);
  }
}

}  // namespace pbnbrdf
