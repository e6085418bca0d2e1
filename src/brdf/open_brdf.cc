#include "pbnbrdf/brdf/open_brdf.h"

#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/builtin.h"
#include "pbnbrdf/brdf/merl.h"
#include "pbnbrdf/brdf/rgl.h"
#include "pbnbrdf/brdf/sgd.h"
#include "pbnbrdf/brdf/tensor_file.h"

namespace pbnbrdf {

std::unique_ptr<Brdf> OpenMeasuredBrdf(const std::string& source) {
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
  if (source.ends_with(".bsdf") ||
      ReadStart(source, TensorFile::kMagic.size()) == TensorFile::kMagic) {
    return std::make_unique<RglBrdf>(RglBrdf::Read(source));
  }
  return std::make_unique<MerlBrdf>(MerlBrdf::Read(source));
}

}  // namespace pbnbrdf
