// builtin.h: analytic materials that ship with the library, for trying things out and for tests.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

struct BuiltinMaterial {
  std::string_view name;
  std::string_view source;  // where the parameters come from
  std::unique_ptr<Brdf> (*make)();
};

std::span<const BuiltinMaterial> BuiltinMaterials();

// Throws Error, naming the known ones, if there is none of that name.
std::unique_ptr<Brdf> MakeBuiltin(std::string_view name);

}  // namespace pbnbrdf
