#include "pbnbrdf/brdf/open_brdf.h"

#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/analytic.h"
#include "pbnbrdf/brdf/builtin.h"
#include "pbnbrdf/brdf/merl.h"
#include "pbnbrdf/brdf/sgd.h"

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
  if (source.ends_with(".json")) {
    return std::make_unique<AnalyticBrdf>(AnalyticBrdf::Read(source));
  }
  if (NamesAnalyticModel(source)) {
    return std::make_unique<AnalyticBrdf>(AnalyticBrdf::FromText(source));
  }
  return std::make_unique<MerlBrdf>(MerlBrdf::Read(source));
}

}  // namespace pbnbrdf
