#include "sources/source_list.h"

#include <fnmatch.h>
#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/file_memo.h"
#include "base/hash.h"
#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/nbrdf_files.h"
#include "pbnbrdf/sources/sgd_file.h"
#include "sources/collection_file.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{4} << 30;
constexpr std::string_view kBuiltin = "builtin:", kSgd = "sgd:";

std::uint64_t FingerprintOfFile(const std::string& path) {
  Fingerprint fingerprint;
  fingerprint.Add(ReadFile(path, kMaxFileBytes));
  return fingerprint.value();
}

bool IsPattern(const std::string& text) { return text.find_first_of("*?[") != std::string::npos; }

std::vector<std::string> FilesLike(const std::string& pattern) {
  glob_t found = {};
  std::vector<std::string> files;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  globfree(&found);
  return files;
}

// Those that the pattern fits, with `before` before each.
std::vector<std::string> NamesLike(const std::string& pattern, const std::string& before,
                                   const std::vector<std::string>& names) {
  std::vector<std::string> sources;
  for (const std::string& name : names) {
    if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) sources.push_back(before + name);
  }
  return sources;
}

std::vector<std::string> Expand(const std::string& part) {
  if (!IsPattern(part)) return {part};
  if (part.starts_with(kBuiltin)) {
    std::vector<std::string> names;
    for (const BuiltinMaterial& material : BuiltinMaterials()) names.emplace_back(material.name);
    return NamesLike(part.substr(kBuiltin.size()), std::string(kBuiltin), names);
  }
  const auto [is_sgd, file, material] = SourceParts(part);
  if (!material.empty()) {
    return NamesLike(material, StrCat(is_sgd ? kSgd : "", file, "#"),
                     is_sgd ? SgdMaterialNames(file) : MaterialNames(file));
  }
  return std::filesystem::exists(part) ? std::vector{part} : FilesLike(part);
}

// What tells sources of the same name apart.
std::string KindOfSource(const std::string& source) {
  for (const std::string_view prefix : {kBuiltin, kSgd}) {
    if (source.starts_with(prefix)) return std::string(prefix.substr(0, prefix.size() - 1));
  }
  const SourceParts parts(source);
  if (!parts.material.empty()) return std::filesystem::path(parts.file).stem();
  return std::filesystem::absolute(source).parent_path().filename();
}

}  // namespace

SourceParts::SourceParts(const std::string& source)
    : is_sgd(source.starts_with(kSgd)), file(source) {
  const std::size_t hash = source.rfind('#');
  if (hash == std::string::npos || (!is_sgd && std::filesystem::exists(source))) return;
  const std::size_t begin = is_sgd ? kSgd.size() : 0;
  file = source.substr(begin, hash - begin);
  material = source.substr(hash + 1);
}

std::vector<std::string> ExpandSources(const std::string& text) {
  std::vector<std::string> all;
  for (const std::string& part : Split(text, ';')) {
    const std::vector<std::string> sources = Expand(part);
    if (sources.empty()) Fail(part, ": nothing has a name like this");
    for (const std::string& source : sources) {
      if (std::find(all.begin(), all.end(), source) == all.end()) all.push_back(source);
    }
  }
  return all;
}

std::string NameOfSource(const std::string& source) {
  if (source.starts_with(kBuiltin)) return source.substr(kBuiltin.size());
  const SourceParts parts(source);
  return parts.material.empty() ? std::filesystem::path(source).stem().string() : parts.material;
}

std::vector<std::string> NamesOfSources(const std::vector<std::string>& sources) {
  std::map<std::string, int> uses;
  for (const std::string& source : sources) ++uses[NameOfSource(source)];
  std::vector<std::string> names;
  std::map<std::string, std::string> known;
  for (const std::string& source : sources) {
    std::string name = NameOfSource(source);
    if (uses[name] > 1) name = StrCat(KindOfSource(source), "-", name);
    const auto [at, is_new] = known.emplace(name, source);
    if (!is_new) Fail(source, " and ", at->second, " would both be named ", name);
    names.push_back(std::move(name));
  }
  return names;
}

std::uint64_t SourceFingerprint(const std::string& source) {
  Fingerprint fingerprint;
  fingerprint.Add(source);
  if (source.starts_with(kBuiltin) || NamesAnalyticModel(source)) return fingerprint.value();
  static FileMemo<std::uint64_t> memo;  // the materials of one file come one after the other
  for (const std::string& file : FilesReadWith(SourceParts(source).file)) {
    fingerprint.Add(StrCat(*memo.Get(file, FingerprintOfFile), " "));
  }
  return fingerprint.value();
}

}  // namespace pbnbrdf
