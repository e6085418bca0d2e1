// extreme_materials.h: materials that no measurement is like, for stress tests: values, shapes and
// gaps in the data at the limits of what a fit may be given.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

struct ExtremeMaterial {
  std::string_view name;
  std::unique_ptr<Brdf> (*make)();
};

std::span<const ExtremeMaterial> ExtremeMaterials();

// One of these or, of other names, a built-in one. Throws Error if there is none of that name.
std::unique_ptr<Brdf> MakeExtremeOrBuiltin(std::string_view name);

}  // namespace pbnbrdf
