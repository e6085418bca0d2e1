#include <array>

#include "base/text.h"
#include "export/code.h"
#include "export/formats.h"
#include "export/primaries.h"
#include "kernels/minimax.h"
#include "mitsuba_plugin_text.h"
#include "network/safetensors.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr Language kPython = {
    .statement = "    $ = $\n",
    .component = {".x", ".y", ".z"},
    .single_precision = false,
    .functions = {"dr.maximum($, $)", "dr.minimum($, $)", "dr.atan2($, $)", "dr.sqrt($)",
                  "dr.log($)", "dr.floor($)", "tanh($)", "expm1($)", "dr.select($ > $, $, $)"}};

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

template <typename Numbers>
std::string ListLiteral(const Numbers& numbers) {
  std::vector<std::string> literals;
  for (const auto number : numbers) literals.push_back(Literal(number));
  return StrCat("[", Join(literals, ", "), "]");
}

// Three lists, of red, green and blue.
std::string PrimariesLiteral() {
  std::array<std::vector<float>, 3> lists;
  for (const Vec3& primary : SpectraOfPrimaries()) {
    lists[0].push_back(static_cast<float>(primary.x));
    lists[1].push_back(static_cast<float>(primary.y));
    lists[2].push_back(static_cast<float>(primary.z));
  }
  std::string text = "[";
  for (const auto& list : lists) text += StrCat("\n    ", ListLiteral(list), ",");
  return text + "]";
}

// A function of wi and wo that gives the list of inputs.
std::string Encoder(std::string_view name, Encoding encoding) {
  const auto [statements, values] = PrintInputs(kPython, encoding);
  return StrCat("def ", name, "(wi, wo):\n", statements, "    return [", Join(values, ", "),
                "]\n\n\n");
}

}  // namespace

std::string MitsubaPlugin(const std::string& network, const std::string& proposal) {
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
                 {"proposal", BytesLiteral(proposal)},
                 {"tanh_most", FormatNumber(kernels::kTanhMost)},
                 {"tanh_numerator", ListLiteral(kernels::kTanhNumerator)},
                 {"tanh_denominator", ListLiteral(kernels::kTanhDenominator)},
                 {"first_wavelength", FormatNumber(kFirstPrimaryWavelength)},
                 {"wavelength_step", FormatNumber(kPrimaryWavelengthStep)},
                 {"primaries", PrimariesLiteral()},
                 {"reflectance", PrintExpression(kPython, ClampedReflectance(Term::Variable("z")))},
                 {"encoders", encoders},
                 {"encodings", encodings},
                 {"activations", activations}});
}

std::string MitsubaProposal(const Proposal& proposal) {
  SafetensorsFile file;
  file.tensors["cells"] = {{proposal.azimuths, proposal.cosines, proposal.rings, proposal.sectors},
                           {proposal.cells.begin(), proposal.cells.end()}};
  file.tensors["cosine_share"] = {{proposal.azimuths, proposal.cosines},
                                  {proposal.cosine_share.begin(), proposal.cosine_share.end()}};
  file.tensors["spread"] = {{1}, {proposal.spread}};
  return SafetensorsBytes(file);
}

}  // namespace pbnbrdf
