#include "option_fields.h"

#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {
namespace {

std::vector<std::vector<int>> ParseNetworks(const std::string& name, std::string_view text) {
  std::vector<std::vector<int>> networks;
  for (const std::string& network : Split(text, ' ')) {
    if (network.empty()) continue;
    networks.emplace_back();
    for (const std::string& size : Split(network, ',')) {
      networks.back().push_back(ParseInteger<int>(name, size));
    }
    NetworkShape(Encoding::kMerl, networks.back(), Activation::kTanh);  // checks the sizes
  }
  return networks;
}

}  // namespace

Field Texts(std::string name, std::vector<std::string>* values, std::string help) {
  return Custom(
      std::move(name), [=](std::string_view text) { *values = Split(text, ','); },
      [=] { return Join(*values, ","); }, [] {}, std::move(help));
}

Field Networks(std::string name, std::vector<std::vector<int>>* networks, std::string help) {
  const auto print = [=] {
    std::vector<std::string> texts;
    for (const std::vector<int>& hidden : *networks) texts.push_back(Joined(hidden, ","));
    return Join(texts, " ");
  };
  return Custom(
      name, [=](std::string_view text) { *networks = ParseNetworks(name, text); }, print, [] {},
      std::move(help));
}

std::string Joined(const std::vector<int>& values, const std::string& separator) {
  std::vector<std::string> texts;
  for (int value : values) texts.push_back(StrCat(value));
  return Join(texts, separator);
}

std::string HiddenName(const std::vector<int>& hidden) { return Joined(hidden, "-"); }

}  // namespace pbnbrdf
