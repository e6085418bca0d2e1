#include "problem/problem_fields.h"

#include <algorithm>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "problem/terms.h"

namespace pbnbrdf {
namespace {

constexpr double kMaxSamples = 1e8;  // 7 GB of samples

const TermType& ParseTermName(const std::string& name) {
  if (const TermType* type = FindTermType(name)) return *type;
  std::string names;
  for (const TermType& type : TermTypes()) {
    names += StrCat(names.empty() ? "" : " | ", type.name);
  }
  Fail("terms=", name, " is not one of ", names);
}

// "log,energy:2": the weight of a term that doesn't name one is its default.
std::vector<WeightedTerm> ParseTerms(std::string_view text) {
  std::vector<WeightedTerm> terms;
  for (const std::string& part : Split(text, ',')) {
    const std::vector<std::string> words = Split(part, ':');
    const TermType& type = ParseTermName(words[0]);
    if (words.size() > 2) Fail("terms: '", part, "' must be NAME or NAME:WEIGHT");
    const double weight = words.size() == 2 ? ParseNumber("terms", words[1]) : type.default_weight;
    terms.push_back({std::string(type.name), weight});
  }
  return terms;
}

std::string PrintTerms(const std::vector<WeightedTerm>& terms) {
  std::string text;
  for (const WeightedTerm& term : terms) {
    text += StrCat(text.empty() ? "" : ",", term.name);
    const TermType* type = FindTermType(term.name);
    if (type != nullptr && type->default_weight == term.weight) continue;
    text.append(":").append(FormatNumber(term.weight));
  }
  return text;
}

void CheckTerms(const std::vector<WeightedTerm>& terms) {
  for (const WeightedTerm& term : terms) {
    ParseTermName(term.name);
    if (!Above(0.0).Holds(term.weight)) {
      Fail("terms: the weight of ", term.name, " = ", term.weight, "; must be finite and > 0");
    }
    const auto is_same = [&](const WeightedTerm& other) { return other.name == term.name; };
    if (std::count_if(terms.begin(), terms.end(), is_same) > 1) {
      Fail("terms: ", term.name, " is there twice");
    }
  }
}

}  // namespace

Fields NetworkFields(NetworkOptions* network) {
  Fields fields;
  fields.Group("The network");
  fields.AddCommon(ChoiceOrAuto("encoding", &network->encoding, kEncodings,
                                "inputs of the network; auto: what suits the material"));
  fields.AddCommon(Integers("hidden", &network->hidden, Between(1, NetworkShape::kMaxLayerSize),
                            "sizes of the hidden layers"));
  fields.Add(
      Choice("activation", &network->activation, kActivations, "function of the hidden units"));
  fields.Add(Choice("initialization", &network->initialization, kInitializations,
                    "distribution of the initial weights"));
  return fields;
}

Fields TermFields(TermOptions* terms) {
  Fields fields;
  fields.Group("The terms");
  fields.AddCommon(Custom(
      "terms", [terms](std::string_view text) { terms->weights = ParseTerms(text); },
      [terms] { return PrintTerms(terms->weights); }, [terms] { CheckTerms(terms->weights); },
      "terms of the cost, separated by commas, each NAME or NAME:WEIGHT: " + TermsHelp()));
  fields.Add(Choice("loss", &terms->loss, kLosses,
                    "loss of the terms over samples; absolute: the papers' own sum, for solvers "
                    "that need no squares"));
  fields.Add(Number("loss_scale", &terms->loss_scale, Above(0.0),
                    "residual at which soft_l1 turns from square to linear"));
  fields.Add(Integer("energy_strata", &terms->energy_strata, Between(1, 1024),
                     "number of theta_i in the energy term, at first"));
  fields.Add(Integer("energy_azimuths", &terms->energy_azimuths, Between(1, 1024),
                     "number of phi_i with each theta_i, for anisotropic encodings"));
  fields.Add(Integer("energy_theta", &terms->energy_theta, Between(2, 1024),
                     "number of theta_h in the energy term's quadrature"));
  fields.Add(Integer("energy_phi", &terms->energy_phi, Between(2, 1024),
                     "number of phi_h in the energy term's quadrature"));
  fields.Add(Switch("energy_skip", &terms->energy_skip,
                    "evaluate angles whose albedo is far below 1 only now and then"));
  return fields;
}

Fields SamplingFields(SamplingOptions* sampling) {
  Fields fields;
  fields.Group("The samples");
  fields.Add(
      Choice("sampling", &sampling->angles, kSamplings,
             "how training angles are drawn; highlight: half of them near the mirror direction"));
  fields.AddCommon(Integer("samples", &sampling->samples, Between(1, kMaxSamples),
                           "maximum number of training samples"));
  fields.AddCommon(Integer("seed", &sampling->seed, AtLeast(0),
                           "seed of the samples and of a network's initial weights"));
  return fields;
}

Fields SceneFields(SamplingOptions* sampling) {
  Fields fields;
  fields.Group("The samples of a scene");
  fields.Add(Number("scene_floor", &sampling->asked_floor, Between(0.0, 1.0),
                    "part of the samples that --sampling draws; the others are drawn at the angles "
                    "at which the scene shows the material"));
  return fields;
}

}  // namespace pbnbrdf
