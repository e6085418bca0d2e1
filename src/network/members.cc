#include "network/members.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr char kNames[] = "materials", kCodes[] = "codes";

std::vector<std::string> NamesOf(const std::vector<DatabaseMember>& members) {
  std::vector<std::string> names;
  for (const DatabaseMember& member : members) names.push_back(member.name);
  return names;
}

}  // namespace

void CheckMembers(const std::vector<DatabaseMember>& members, std::size_t code_size) {
  if (members.empty()) Fail("no materials");
  std::set<std::string_view> names;
  for (const auto& [name, code] : members) {
    if (name.empty() || name.find(';') != name.npos) Fail("'", name, "' is no name of a material");
    if (!names.insert(name).second) Fail("two materials are named ", name);
    if (code.size() != code_size) {
      Fail("codes: ", code.size(), " numbers for ", name, ", not ", code_size);
    }
    if (!std::all_of(code.begin(), code.end(), [](double x) { return std::isfinite(x); })) {
      Fail("codes: one of ", name, " isn't finite");
    }
  }
}

const DatabaseMember& FindMember(const std::vector<DatabaseMember>& members,
                                 const std::string& name) {
  const auto found =
      std::find_if(members.begin(), members.end(),
                   [&](const DatabaseMember& member) { return member.name == name; });
  if (found != members.end()) return *found;
  Fail("none of its ", members.size(), " materials is named '", name, "'; the nearest name is '",
       Nearest(NamesOf(members), name), "'");
}

void AddMembers(const std::vector<DatabaseMember>& members, SafetensorsFile* file) {
  file->metadata[kNames] = Join(NamesOf(members), ";");
  Tensor& codes = file->tensors[kCodes];
  codes.shape = {static_cast<std::int64_t>(members.size()),
                 static_cast<std::int64_t>(members.front().code.size())};
  for (const DatabaseMember& member : members) {
    codes.values.insert(codes.values.end(), member.code.begin(), member.code.end());
  }
}

std::vector<DatabaseMember> ReadMembers(const SafetensorsFile& file) {
  const std::vector<std::string> names = Split(MetadataOf(file, kNames), ';');
  const std::vector<double>& codes = TensorOf(file, kCodes).values;
  const std::size_t size = codes.size() / names.size();
  if (size * names.size() != codes.size()) {
    Fail("codes: ", codes.size(), " numbers for ", names.size(), " materials");
  }
  std::vector<DatabaseMember> members;
  auto from = codes.begin();
  for (const std::string& name : names) {
    const auto to = from + static_cast<std::ptrdiff_t>(size);
    members.push_back({name, {from, to}});
    from = to;
  }
  return members;
}

const Tensor& TensorOf(const SafetensorsFile& file, const std::string& name) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) Fail("tensor ", name, " is missing");
  return found->second;
}

const std::string& MetadataOf(const SafetensorsFile& file, const std::string& key) {
  const auto found = file.metadata.find(key);
  if (found == file.metadata.end()) Fail("__metadata__ lacks ", key);
  return found->second;
}

}  // namespace pbnbrdf
