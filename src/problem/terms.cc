#include "problem/terms.h"

#include <algorithm>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/residuals/energy_residual.h"
#include "problem/chromaticity_term.h"
#include "problem/log_term.h"

namespace pbnbrdf {
namespace {

template <class Functor, class Term = JetTerm<Functor>>
constexpr TermType OverSamples() {
  return {Functor::kName, Functor::kHelp, Functor::kDefaultWeight, Functor::kNeedsColor,
          []() -> std::unique_ptr<SampleTerm> { return std::make_unique<Term>(); }};
}

constexpr TermType kTypes[] = {
    OverSamples<LogResidual, LogTerm>(),
    OverSamples<ChromaticityResidual, ChromaticityTerm>(),
    {EnergyResidual::kName, EnergyResidual::kHelp, EnergyResidual::kDefaultWeight, false, nullptr},
};

}  // namespace

std::span<const TermType> TermTypes() { return kTypes; }

const TermType* FindTermType(std::string_view name) {
  const auto found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                  [&](const TermType& type) { return type.name == name; });
  return found == std::end(kTypes) ? nullptr : &*found;
}

std::string TermsHelp() {
  std::string text;
  for (const TermType& type : kTypes) {
    text += StrCat(text.empty() ? "" : " | ", type.name, " (", type.help, ")");
  }
  return text;
}

std::vector<WeightedSampleTerm> MakeSampleTerms(const TermOptions& terms) {
  std::vector<WeightedSampleTerm> made;
  for (const WeightedTerm& term : terms.weights) {
    const TermType* type = FindTermType(term.name);
    if (type != nullptr && type->make != nullptr) made.push_back({term.weight, type->make()});
  }
  return made;
}

}  // namespace pbnbrdf
