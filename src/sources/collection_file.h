// collection_file.h: files that hold several materials, each by its name: a shared network or principal
// components, with a code for each.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pbnbrdf/network/weight_family.h"
#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// Both have members() and Material(name).
using Collection = std::variant<WeightFamily, TablePca>;

// From the first bytes of a file, a kilobyte or more.
bool LooksLikeCollection(std::string_view start);

// These throw Error, also if the file is no collection. The last file that was read stays in memory: a file's
// materials are mostly wanted one after the other, and a file of principal components has hundreds of MB.
std::shared_ptr<const Collection> ReadCollection(const std::string& path);
std::vector<std::string> MaterialNames(const std::string& path);
std::unique_ptr<Brdf> OpenMaterial(const std::string& path, const std::string& name);

}  // namespace pbnbrdf
