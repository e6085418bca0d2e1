// opened_fit.h: the flag --fit: a fitted network or analytic model, from its file.
#pragma once

#include <memory>
#include <string>

#include "base/fields.h"
#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf::cli {

struct OpenedFit {
  std::unique_ptr<Brdf> brdf;
  std::size_t parameters;  // numbers that it stores
};

// Throws Error if the source is neither a network nor an analytic model.
OpenedFit OpenFit(const std::string& source);

Field FitField(std::string* source);

}  // namespace pbnbrdf::cli
