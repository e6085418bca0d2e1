// database_member.h: a material of a database, which what the materials have in common and a few numbers tell.
#pragma once

#include <string>
#include <vector>

namespace pbnbrdf {

struct DatabaseMember {
  std::string name;  // of the material; each once, without ';'
  std::vector<double> code;
};

}  // namespace pbnbrdf
