#include "pbnbrdf/export/mitsuba_plugin.h"

#include "mitsuba_plugin_text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/text.h"

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

std::string MitsubaPlugin(const std::string& network, const SamplingLobe& lobe) {
  std::string text = kMitsubaPluginText;
  ReplaceLine(&text, "b\"network.safetensors\"", BytesLiteral(network));
  ReplaceLine(&text, "\nALPHA = 0.5\n", StrCat("\nALPHA = ", FormatNumber(lobe.alpha), "\n"));
  ReplaceLine(&text, "\nGLOSSY = 0.5\n", StrCat("\nGLOSSY = ", FormatNumber(lobe.weight), "\n"));
  return text;
}

}  // namespace pbnbrdf
