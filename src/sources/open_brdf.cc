#include "pbnbrdf/sources/open_brdf.h"

#include <string_view>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/nbrdf_files.h"
#include "pbnbrdf/sources/rgl.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "pbnbrdf/sources/sgd_file.h"
#include "sources/tensor_file.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kStart = 4096;  // bytes that tell what a file is
constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n", kNpyMagic = "\x93NUMPY";

template <class Source>
std::unique_ptr<Brdf> Boxed(Source source) {
  return std::make_unique<Source>(std::move(source));
}

// A JSON object behind its 8-byte length.
bool LooksLikeSafetensors(std::string_view start) {
  return start.size() > 8 && start[8] == '{' && start.substr(6, 2) == std::string_view("\0\0", 2);
}

bool LooksLikeModel(std::string_view start) {
  return Trim(start).starts_with("{") && start.find("\"model\"") != start.npos;
}

// The first line that isn't a comment names columns of directions.
bool LooksLikeCsv(std::string_view start) {
  while (!start.empty()) {
    const std::string_view line = start.substr(0, start.find('\n'));
    if (!Trim(line).empty() && !line.starts_with("#")) {
      return line.find(',') != line.npos &&
             (line.find("theta_i") != line.npos || line.find("wi_x") != line.npos);
    }
    start.remove_prefix(std::min(line.size() + 1, start.size()));
  }
  return false;
}

// A format of files: what its first bytes look like, and how the names of its files end.
struct Format {
  bool (*recognizes)(std::string_view start);
  std::initializer_list<std::string_view> endings;
  std::unique_ptr<Brdf> (*open)(const std::string& path);
};

// Files are told by what they hold; where nothing recognises it, as in a damaged file, by their names. The
// last format has no mark of its own: it is what all else is taken for.
const Format kFormats[] = {
    {LooksLikeSafetensors,
     {".safetensors"},
     [](const std::string& path) { return Boxed(NeuralBrdf::Read(path)); }},
    {[](std::string_view start) {
       return start.starts_with(kHdf5Magic) || start.starts_with(kNpyMagic);
     },
     {".h5", ".hdf5", ".npy"},
     [](const std::string& path) { return Boxed(ReadNbrdf(path)); }},
    {LooksLikeModel,
     {".json"},
     [](const std::string& path) { return Boxed(AnalyticBrdf::Read(path)); }},
    {[](std::string_view start) { return start.starts_with(TensorFile::kMagic); },
     {".bsdf"},
     [](const std::string& path) { return Boxed(RglBrdf::Read(path)); }},
    {LooksLikeAlta,
     {".alta", ".dat"},
     [](const std::string& path) { return Boxed(ReadAlta(path)); }},
    {LooksLikeCsv, {".csv"}, [](const std::string& path) { return Boxed(ReadScatteredCsv(path)); }},
    {[](std::string_view) { return false; },
     {".binary"},
     [](const std::string& path) { return Boxed(MerlBrdf::Read(path)); }},
};

const Format& FormatOf(const std::string& path) {
  const std::string start = ReadStart(path, kStart);
  for (const Format& format : kFormats) {
    if (format.recognizes(start)) return format;
  }
  for (const Format& format : kFormats) {
    for (std::string_view ending : format.endings) {
      if (path.ends_with(ending)) return format;
    }
  }
  return kFormats[std::size(kFormats) - 1];
}

}  // namespace

std::unique_ptr<Brdf> OpenBrdf(const std::string& source) {
  constexpr std::string_view kBuiltin = "builtin:", kSgd = "sgd:";
  if (source.starts_with(kBuiltin)) return MakeBuiltin(source.substr(kBuiltin.size()));
  if (source.starts_with(kSgd)) {
    const std::string rest = source.substr(kSgd.size());
    const std::size_t hash = rest.rfind('#');
    if (hash == std::string::npos || hash + 1 == rest.size()) {
      Fail(source, ": expected sgd:PARAMETERS.csv#MATERIAL");
    }
    return Boxed(ReadSgd(rest.substr(0, hash), rest.substr(hash + 1)));
  }
  if (NamesAnalyticModel(source)) return Boxed(AnalyticBrdf::FromText(source));
  return FormatOf(source).open(source);
}

NeuralBrdf OpenNetwork(const std::string& path) {
  return IsNbrdfFile(path) ? ReadNbrdf(path) : NeuralBrdf::Read(path);
}

}  // namespace pbnbrdf
