// about.h: errors that say what they are about.
#pragma once

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

// Runs the function. If it throws Error, so does this, with "<subject>: " before the message.
template <typename Subject, typename Function>
auto About(const Subject& subject, Function function) {
  try {
    return function();
  } catch (const Error& error) {
    Fail(subject, ": ", error.what());
  }
}

}  // namespace pbnbrdf
