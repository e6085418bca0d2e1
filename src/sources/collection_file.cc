#include "sources/collection_file.h"

#include "base/about.h"
#include "base/file_memo.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kStart = 1 << 12;  // bytes; the metadata come first in a header

bool Names(std::string_view start, std::string_view format) {
  return start.find(StrCat("\"format\":\"", format, "\"")) != start.npos;
}

Collection Read(const std::string& path) {
  const std::string start = ReadStart(path, kStart);
  if (Names(start, WeightFamily::kFormat)) return WeightFamily::Read(path);
  if (Names(start, TablePca::kFormat)) return TablePca::Read(path);
  Fail(path, ": holds no materials by name: it isn't what pbnbrdf prior writes");
}

}  // namespace

bool LooksLikeCollection(std::string_view start) {
  const std::string_view first = start.substr(0, kStart);
  return Names(first, WeightFamily::kFormat) || Names(first, TablePca::kFormat);
}

std::shared_ptr<const Collection> ReadCollection(const std::string& path) {
  static FileMemo<Collection> memo;
  return memo.Get(path, Read);
}

std::vector<std::string> MaterialNames(const std::string& path) {
  return std::visit(
      [](const auto& collection) {
        std::vector<std::string> names;
        for (const DatabaseMember& member : collection.members()) names.push_back(member.name);
        return names;
      },
      *ReadCollection(path));
}

std::unique_ptr<Brdf> OpenMaterial(const std::string& path, const std::string& name) {
  const auto collection = ReadCollection(path);
  return About(path, [&] {
    return std::visit(
        [&](const auto& known) -> std::unique_ptr<Brdf> {
          auto material = known.Material(name);
          return std::make_unique<decltype(material)>(std::move(material));
        },
        *collection);
  });
}

}  // namespace pbnbrdf
