#include "export/mitsuba_plugin.h"

#include "base/text.h"
#include "mitsuba_plugin_text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

void ReplaceLine(std::string* text, std::string_view line, const std::string& by) {
  const std::size_t at = text->find(line);
  if (at == std::string::npos) Fail("the plugin's text has no line ", line);
  text->replace(at, line.size(), by);
}

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

}  // namespace

std::string MitsubaPlugin(const std::string& network, const LobeProposal& proposal) {
  std::string text = kMitsubaPluginText;
  const auto set_number = [&](const std::string& name, double value) {
    ReplaceLine(&text, StrCat("\n", name, " = 0.5\n"),
                StrCat("\n", name, " = ", FormatNumber(value), "\n"));
  };
  ReplaceLine(&text, "b\"network.safetensors\"", BytesLiteral(network));
  set_number("ALPHA_U", proposal.alpha.x);
  set_number("ALPHA_V", proposal.alpha.y);
  set_number("LOBE_WEIGHT", proposal.lobe_weight);
  return text;
}

}  // namespace pbnbrdf
