#include "sources/keras_archive.h"

#include <zip.h>

#include <memory>

#include "network/tensor.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr const char* kWeightsName = "model.weights.h5";

[[noreturn]] void FailDamaged(const std::string& path, const char* reason) {
  Fail(path, ": truncated or damaged ZIP archive (", reason, "); copy it again");
}

// Frees the text that it lends.
struct ZipError {
  ZipError() { zip_error_init(&error); }
  ~ZipError() { zip_error_fini(&error); }
  const char* text() { return zip_error_strerror(&error); }
  zip_error_t error;
};

}  // namespace

std::string WeightsInArchive(const std::string& path, std::string_view bytes) {
  ZipError error;
  zip_source_t* source =
      zip_source_buffer_create(bytes.data(), bytes.size(), /*freep=*/0, &error.error);
  if (source == nullptr) FailDamaged(path, error.text());
  const std::unique_ptr<zip_t, decltype(&zip_discard)> archive(
      zip_open_from_source(source, ZIP_RDONLY, &error.error), zip_discard);
  if (!archive) {
    zip_source_free(source);
    FailDamaged(path, error.text());
  }
  zip_stat_t entry;
  if (zip_stat(archive.get(), kWeightsName, 0, &entry) != 0) {
    Fail(path, ": a ZIP archive without ", kWeightsName, "; expected a model that Keras saved");
  }
  if ((entry.valid & ZIP_STAT_SIZE) == 0 || entry.size > kMaxWeightFileSize) {
    Fail(path, ": ", kWeightsName, " has more than ", kMaxWeightFileSize, " bytes");
  }
  const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(
      zip_fopen_index(archive.get(), entry.index, 0), zip_fclose);
  // One byte more than there are: the archive's checksum is looked at where the file ends.
  std::string weights(entry.size + 1, '\0');
  if (!file ||
      zip_fread(file.get(), weights.data(), entry.size) != static_cast<zip_int64_t>(entry.size) ||
      zip_fread(file.get(), &weights[entry.size], 1) != 0) {
    FailDamaged(path, file ? zip_file_strerror(file.get()) : zip_strerror(archive.get()));
  }
  weights.pop_back();
  return weights;
}

}  // namespace pbnbrdf
