// archive_writer.h: ZIP archives for tests, as models of Keras 3 are.
#pragma once

#include <zip.h>

#include <string>

#include "test_util.h"

namespace pbnbrdf {

// With one file in it.
inline void WriteArchive(const std::string& path, const std::string& name,
                         const std::string& content) {
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
  ASSERT_GE(zip_file_add(archive, name.c_str(), source, 0), 0);
  ASSERT_EQ(zip_close(archive), 0);
}

}  // namespace pbnbrdf
