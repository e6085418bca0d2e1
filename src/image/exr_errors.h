// exr_errors.h: OpenEXR's exceptions as this library's.
#pragma once

#include <exception>
#include <new>
#include <string>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

// OpenEXR's messages name the file once or more before they come to the point.
inline std::string ExrReason(const std::exception& error) {
  const std::string text = error.what();
  const std::size_t name_end = text.rfind("\". ");
  return name_end == std::string::npos ? text : text.substr(name_end + 3);
}

// Runs functions of OpenEXR. What they throw becomes an Error that begins with `before`.
template <typename Function>
auto TranslateExrErrors(const std::string& before, Function function) {
  try {
    return function();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    Fail(before, ExrReason(error));
  }
}

}  // namespace pbnbrdf
