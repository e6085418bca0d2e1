// members.h: the materials of a database as its file has them: names between semicolons in the metadata, codes
// in a tensor.
#pragma once

#include <string>
#include <vector>

#include "network/safetensors.h"
#include "pbnbrdf/network/database_member.h"

namespace pbnbrdf {

// Throws Error unless there are some, each has a name of its own and a code of `code_size` finite numbers.
void CheckMembers(const std::vector<DatabaseMember>& members, std::size_t code_size);

// Throws Error, which has the nearest name, if there is none of that name.
const DatabaseMember& FindMember(const std::vector<DatabaseMember>& members,
                                 const std::string& name);

// Adds "materials" and the tensor codes (M x K).
void AddMembers(const std::vector<DatabaseMember>& members, SafetensorsFile* file);
std::vector<DatabaseMember> ReadMembers(const SafetensorsFile& file);

// Of a file that must have it. Throws Error.
const Tensor& TensorOf(const SafetensorsFile& file, const std::string& name);
const std::string& MetadataOf(const SafetensorsFile& file, const std::string& key);

}  // namespace pbnbrdf
