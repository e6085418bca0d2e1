// sgd_file.h: the parameters of SGD materials (models/sgd.h), as a CSV table.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/models/sgd.h"

namespace pbnbrdf {

// material: a name of the first or the second column. Its three rows, one for each of the channels r, g and
// b, hold the parameters. Throws Error, naming the file and the line.
SgdBrdf ReadSgd(const std::string& path, const std::string& material);

// The names of all materials, those of the first column, in the file's order.
std::vector<std::string> SgdMaterialNames(const std::string& path);

}  // namespace pbnbrdf
