#include "pbnbrdf/sources/open_brdf.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/about.h"
#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/weight_family.h"
#include "pbnbrdf/sources/astm.h"
#include "pbnbrdf/sources/cornell.h"
#include "pbnbrdf/sources/fred.h"
#include "pbnbrdf/sources/in_plane.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/nbrdf_files.h"
#include "pbnbrdf/sources/rgl.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "pbnbrdf/sources/sgd_file.h"
#include "pbnbrdf/sources/zemax.h"
#include "sources/collection_file.h"
#include "sources/source_list.h"
#include "sources/tensor_file.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kStart = 1 << 16;  // bytes that tell what a file is; long comments come first

template <class Source>
std::unique_ptr<Brdf> Boxed(Source source) {
  return std::make_unique<Source>(std::move(source));
}

// What tells a file's format: its first bytes, and how many it has.
struct Content {
  std::string_view start;
  std::uintmax_t size;
};

// A JSON object behind its 8-byte length.
bool LooksLikeSafetensors(const Content& file) {
  return file.start.size() > 8 && file.start[8] == '{' &&
         file.start.substr(6, 2) == std::string_view("\0\0", 2);
}

bool LooksLikeModel(const Content& file) {
  return Trim(file.start).starts_with("{") && file.start.find("\"model\"") != file.start.npos;
}

// A grid, and as many bytes as it asks for.
bool LooksLikeMerl(const Content& file) {
  std::array<std::int32_t, 3> grid;
  if (file.start.size() < sizeof(grid)) return false;
  std::memcpy(grid.data(), file.start.data(), sizeof(grid));
  const double bins = double(grid[0]) * double(grid[1]) * double(grid[2]);
  return *std::min_element(grid.begin(), grid.end()) > 0 &&
         static_cast<double>(file.size) == sizeof(grid) + 3.0 * sizeof(double) * bins;
}

// A format of files: what it is called, what its first bytes look like, how the names of its files end.
struct Format {
  std::string_view name;
  bool (*recognizes)(const Content& file);
  std::initializer_list<std::string_view> endings;
  std::unique_ptr<Brdf> (*open)(const std::string& path);
};

// Files are told by what they hold; where nothing recognises it, as in a damaged file, by their names.
const Format kFormats[] = {
    {"collection of materials",
     [](const Content& file) {
       return LooksLikeSafetensors(file) && LooksLikeCollection(file.start);
     },
     {},
     [](const std::string& path) -> std::unique_ptr<Brdf> {
       const std::vector<std::string> names = MaterialNames(path);
       Fail(path, ": holds ", names.size(), " materials; name one: ", path, "#", names.front());
     }},
    {"safetensors network",
     LooksLikeSafetensors,
     {".safetensors"},
     [](const std::string& path) { return Boxed(NeuralBrdf::Read(path)); }},
    {"Keras or NumPy network",
     [](const Content& file) { return LooksLikeNbrdf(file.start); },
     {".h5", ".hdf5", ".keras", ".npy"},
     [](const std::string& path) { return Boxed(ReadNbrdf(path)); }},
    {"analytic model",
     LooksLikeModel,
     {".json"},
     [](const std::string& path) { return Boxed(AnalyticBrdf::Read(path)); }},
    {"RGL file",
     [](const Content& file) { return file.start.starts_with(TensorFile::kMagic); },
     {".bsdf"},
     [](const std::string& path) { return Boxed(RglBrdf::Read(path)); }},
    {"ALTA measurements",
     [](const Content& file) { return LooksLikeAlta(file.start); },
     {".alta", ".dat"},
     [](const std::string& path) { return Boxed(ReadAlta(path)); }},
    {"Zemax measurements",
     [](const Content& file) { return LooksLikeZemax(file.start); },
     {},
     [](const std::string& path) { return Boxed(ReadZemax(path)); }},
    {"FRED measurements",
     [](const Content& file) { return LooksLikeFred(file.start); },
     {},
     [](const std::string& path) { return Boxed(ReadFred(path)); }},
    {"ASTM measurements",
     [](const Content& file) { return LooksLikeAstm(file.start); },
     {".astm"},
     [](const std::string& path) { return Boxed(ReadAstm(path)); }},
    {"Cornell measurements",
     [](const Content& file) { return LooksLikeCornell(file.start); },
     {".brdf"},
     [](const std::string& path) { return Boxed(ReadCornell(path)); }},
    {"in-plane measurements",
     [](const Content& file) { return LooksLikeInPlane(file.start); },
     {},
     [](const std::string& path) { return Boxed(ReadInPlane(path)); }},
    {"CSV measurements",
     [](const Content& file) { return LooksLikeScatteredCsv(file.start); },
     {".csv"},
     [](const std::string& path) { return Boxed(ReadScatteredCsv(path)); }},
    {"MERL table",
     LooksLikeMerl,
     {".binary"},
     [](const std::string& path) { return Boxed(MerlBrdf::Read(path)); }},
};

[[noreturn]] void FailUnknown(const std::string& path) {
  std::string names;
  for (const Format& format : kFormats) names += StrCat(names.empty() ? "" : ", ", format.name);
  Fail(path, ": not recognised; it is none of: ", names);
}

const Format& FormatOf(const std::string& path) {
  const std::string bytes = ReadStart(path, kStart);
  const std::string_view start = bytes;
  const std::size_t mark = start.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  for (const Format& format : kFormats) {
    if (format.recognizes({start.substr(mark), FileSize(path)})) return format;
  }
  const std::string name = LowerCase(path);
  for (const Format& format : kFormats) {
    for (std::string_view ending : format.endings) {
      if (name.ends_with(ending)) return format;
    }
  }
  FailUnknown(path);
}

}  // namespace

std::unique_ptr<Brdf> OpenBrdf(const std::string& source) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (source.starts_with(kBuiltin)) return MakeBuiltin(source.substr(kBuiltin.size()));
  if (NamesAnalyticModel(source)) return Boxed(AnalyticBrdf::FromText(source));
  const auto [is_sgd, file, material] = SourceParts(source);
  if (is_sgd) {
    if (material.empty()) Fail(source, ": expected sgd:PARAMETERS.csv#MATERIAL");
    return Boxed(ReadSgd(file, material));
  }
  if (!material.empty()) return OpenMaterial(file, material);
  return FormatOf(source).open(source);
}

NeuralBrdf OpenNetwork(const std::string& path) {
  if (const SourceParts parts(path); !parts.material.empty()) {
    return About(parts.file,
                 [&] { return WeightFamily::Read(parts.file).Material(parts.material); });
  }
  const bool nbrdf = IsNbrdfFile(path) || LooksLikeNbrdf(ReadStart(path, kStart));
  return nbrdf ? ReadNbrdf(path) : NeuralBrdf::Read(path);
}

}  // namespace pbnbrdf
