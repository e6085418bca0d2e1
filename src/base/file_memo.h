// file_memo.h: what was last made of a file, kept while the file stays as it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace pbnbrdf {

// For threads to share. A pipe, which can be read once, isn't kept.
template <typename Value>
class FileMemo {
 public:
  // What read(path) returns: a Value, read now unless it is there already. Throws what `read` throws.
  template <typename Read>
  std::shared_ptr<const Value> Get(const std::string& path, Read read) {
    const std::lock_guard lock(mutex_);
    const std::optional<Version> version = VersionOf(path);
    if (version && version == version_) return value_;
    version_.reset();
    value_.reset();  // before the next one is read: it can be large
    auto value = std::make_shared<const Value>(read(path));
    if (!version) return value;
    version_ = version;
    return value_ = std::move(value);
  }

 private:
  struct Version {
    std::string path;
    std::uintmax_t size;
    std::filesystem::file_time_type written;
    bool operator==(const Version&) const = default;
  };

  static std::optional<Version> VersionOf(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return {};
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) return {};
    const auto written = std::filesystem::last_write_time(path, error);
    if (error) return {};
    return Version{path, size, written};
  }

  std::mutex mutex_;
  std::optional<Version> version_;
  std::shared_ptr<const Value> value_;
};

}  // namespace pbnbrdf
