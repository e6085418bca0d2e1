// shared_flags.h: flags that more than one subcommand has.
#pragma once

#include <gflags/gflags_declare.h>

#include <memory>

#include "command_line.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/brdf.h"

DECLARE_string(material);
DECLARE_double(scale_to_albedo);
DECLARE_string(fit);
DECLARE_string(out);
DECLARE_bool(json);

namespace pbnbrdf::cli {

// Runs what may find fault with the material, and puts its name before the message.
template <typename Function>
auto AboutMaterial(Function function) {
  try {
    return function();
  } catch (const Error& error) {
    Fail(FLAGS_material, ": ", error.what());
  }
}

// The flags that say what the material is; every command that reads it has all of them.
std::vector<std::string> MaterialFlags();

// MaterialFlags and the command's own ones after them.
FlagGroup MaterialFlagsAnd(std::vector<std::string> names);

// Throws UsageError if --material is missing or --scale_to_albedo isn't a scale. OpenMaterial asks
// too; to be called first where other things are done before the material is opened.
void CheckMaterialFlags();

// The material that the flags describe. Throws Error, and what CheckMaterialFlags does.
std::unique_ptr<Brdf> OpenMaterial();

}  // namespace pbnbrdf::cli
