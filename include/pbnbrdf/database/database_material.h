// database_material.h: a material of a database, before anything is made of it.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

struct DatabaseMaterial {
  std::string name;  // each once, without ';'
  std::shared_ptr<const Brdf> brdf;
};

}  // namespace pbnbrdf
