// files.h: whole files in and out, with errors that name the file; nothing is left half-written.
//
// What is read may also be a pipe or a device, such as /dev/stdin: it is read to its end once, at most 256 MiB,
// and kept; to read the same path again gives the same bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

// The file's size in bytes. Throws Error if it is missing or a folder.
std::uintmax_t FileSize(const std::string& path);

// The file's bytes. Throws Error if it can't be read or is larger than `limit` bytes.
std::string ReadFile(const std::string& path, std::uintmax_t limit);

// The first `most` bytes, fewer if the file is shorter. Throws Error if it can't be read.
std::string ReadStart(const std::string& path, std::size_t most);

// Writes to a temporary file in the same folder and renames that to `path`, so that `path` holds
// either its old content or all of the new; a link, device or pipe stays one. "-" is standard output.
// Throws Error; the temporary file is removed.
void WriteFile(const std::string& path, std::string_view content);

struct FileContent {
  std::string path, content;
};

// Several regular files, in one folder or more: none is replaced before the new content of all is
// on the disk. Throws Error; the temporary files are removed. A single one may be what WriteFile takes, and
// "-" among them is standard output, which comes last.
void WriteFiles(const std::vector<FileContent>& files);

// Throws Error unless WriteFile(path, ...) has a folder to write to that grants it: asked before a
// long computation, so that its result isn't lost.
void CheckWritable(const std::string& path);

// Removes temporary files of WriteFile in the folder that processes of this machine have left behind, ended by
// SIGKILL or with the machine.
void RemovePartialFiles(const std::string& folder);

}  // namespace pbnbrdf
