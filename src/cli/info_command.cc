// pbnbrdf info
#include <iostream>

#include "commands.h"
#include "pbnbrdf/brdf/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/network/open_brdf.h"

namespace pbnbrdf::cli {
namespace {

void ListBuiltins() {
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    std::cout << "builtin:" << material.name << "\n    " << material.make()->Description()
              << "\n    " << material.source << "\n";
  }
}

// Indents the further lines of a text.
std::string Indented(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; ++at) {
    text.replace(at, 1, "\n    ");
  }
  return text;
}

int RunInfo(const std::string& source) {
  if (source == "builtin:") {
    ListBuiltins();
    return 0;
  }
  const std::unique_ptr<Brdf> brdf = OpenBrdf(source);
  std::cout << source << ": " << brdf->Description() << "\n";
  if (const auto* network = dynamic_cast<const NeuralBrdf*>(brdf.get())) {
    for (const auto& [key, value] : network->metadata()) {
      std::cout << "  " << key << ": " << Indented(value) << "\n";
    }
  }
  return 0;
}

}  // namespace

Command InfoCommand() {
  Command command;
  command.name = "info";
  command.summary = "says what a source of reflectance is";
  command.usage =
      "  pbnbrdf info gold.safetensors\n"
      "  pbnbrdf info builtin:          lists the materials that ship with the program\n";
  command.notes = kSourceNotes;
  command.argument = "a file or another source";
  command.run = RunInfo;
  return command;
}

}  // namespace pbnbrdf::cli
