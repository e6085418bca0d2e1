#include "pbnbrdf/sources/open_brdf.h"

#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/models/sgd.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/nbrdf_files.h"
#include "pbnbrdf/sources/rgl.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "sources/tensor_file.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kStart = 4096;  // bytes that tell what a file is

// Its name's end says what it is, else its first bytes.
std::unique_ptr<Brdf> OpenFile(const std::string& path) {
  if (path.ends_with(".csv")) return std::make_unique<ScatteredBrdf>(ReadScatteredCsv(path));
  if (path.ends_with(".binary")) return std::make_unique<MerlBrdf>(MerlBrdf::Read(path));
  const std::string start = ReadStart(path, kStart);
  if (path.ends_with(".bsdf") || start.starts_with(TensorFile::kMagic)) {
    return std::make_unique<RglBrdf>(RglBrdf::Read(path));
  }
  if (path.ends_with(".alta") || path.ends_with(".dat") || LooksLikeAlta(start)) {
    return std::make_unique<ScatteredBrdf>(ReadAlta(path));
  }
  return std::make_unique<MerlBrdf>(MerlBrdf::Read(path));
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
    return std::make_unique<SgdBrdf>(SgdBrdf::Read(rest.substr(0, hash), rest.substr(hash + 1)));
  }
  if (source.ends_with(".json")) {
    return std::make_unique<AnalyticBrdf>(AnalyticBrdf::Read(source));
  }
  if (NamesAnalyticModel(source)) {
    return std::make_unique<AnalyticBrdf>(AnalyticBrdf::FromText(source));
  }
  if (source.ends_with(".safetensors") || IsNbrdfFile(source)) {
    return std::make_unique<NeuralBrdf>(OpenNetwork(source));
  }
  return OpenFile(source);
}

NeuralBrdf OpenNetwork(const std::string& path) {
  return IsNbrdfFile(path) ? ReadNbrdf(path) : NeuralBrdf::Read(path);
}

}  // namespace pbnbrdf
