#include "base/text.h"
#include "export/code.h"
#include "export/formats.h"
#include "mitsuba_plugin_text.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr Language kPython = {
    .statement = "    $ = $\n",
    .component = {".x", ".y", ".z"},
    .single_precision = false,
    .functions = {"dr.maximum($, $)", "dr.minimum($, $)", "dr.atan2($, $)", "dr.sqrt($)",
                  "dr.log($)", "dr.floor($)", "dr.tanh($)", "expm1($)", "dr.select($ > $, $, $)"}};

// A bytes literal of Python: whatever bytes a file's name has.
std::string BytesLiteral(const std::string& bytes) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string literal;
  for (unsigned char c : bytes) {
    if (c >= ' ' && c <= '~' && c != '"' && c != '\\') {
      literal += static_cast<char>(c);
    } else {
      literal += {'\\', 'x', kHex[c >> 4], kHex[c & 15]};
    }
  }
  return "b\"" + literal + "\"";
}

// A function of wi and wo that gives the list of inputs.
std::string Encoder(std::string_view name, Encoding encoding) {
  const auto [statements, values] = PrintInputs(kPython, encoding);
  return StrCat("def ", name, "(wi, wo):\n", statements, "    return [", Join(values, ", "),
                "]\n\n\n");
}

}  // namespace

std::string MitsubaPlugin(const std::string& network, const LobeProposal& proposal) {
  std::string encoders, encodings, activations;
  for (const auto& [name, encoding] : kEncodings) {
    encoders += Encoder(name, encoding);
    encodings += StrCat("\n    \"", name, "\": (", name, ", ",
                        IsIsotropic(encoding) ? "True" : "False", "),");
  }
  for (const auto& [name, activation] : kActivations) {
    activations += StrCat("\n    \"", name, "\": lambda x: ",
                          PrintExpression(kPython, Activate(activation, Term::Variable("x"))), ",");
  }
  return FillIn(kMitsubaPluginText,
                {{"network", BytesLiteral(network)},
                 {"alpha_u", FormatNumber(proposal.alpha.x)},
                 {"alpha_v", FormatNumber(proposal.alpha.y)},
                 {"lobe_weight", FormatNumber(proposal.lobe_weight)},
                 {"reflectance", PrintExpression(kPython, ClampedReflectance(Term::Variable("z")))},
                 {"encoders", encoders},
                 {"encodings", encodings},
                 {"activations", activations}});
}

}  // namespace pbnbrdf
