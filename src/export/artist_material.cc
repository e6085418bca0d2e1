// Principled models for artists' programs: glTF 2.0 and MaterialX.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "base/text.h"
#include "export/code.h"
#include "export/formats.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Parameters by name; `Is` compares with a number, so that what changes nothing can be left out.
class Principled {
 public:
  explicit Principled(const AnalyticBrdf& brdf) {
    if (brdf.model().name != "principled") {
      Fail("needs a principled model, not ", brdf.Description());
    }
    for (const auto& [name, values] : brdf.NamedValues()) values_[name] = values;
  }

  const std::vector<double>& Of(const std::string& name) const { return values_.at(name); }
  double Number(const std::string& name) const { return Of(name)[0]; }
  bool Is(const std::string& name, double value) const {
    const std::vector<double>& values = Of(name);
    return std::count(values.begin(), values.end(), value) == std::ptrdiff_t(values.size());
  }

 private:
  AnalyticBrdf::Values values_;
};

// What the file says of the approximation: of which material, and how far it is from it.
std::vector<std::pair<std::string, Json>> Remarks(const AnalyticBrdf& brdf) {
  std::vector<std::pair<std::string, Json>> remarks;
  const auto& metadata = brdf.metadata();
  if (const auto found = metadata.find("material"); found != metadata.end()) {
    remarks.emplace_back("material", found->second);
  }
  const auto found = metadata.find("errors");
  const Json errors = found == metadata.end() ? Json() : ParseJson(found->second);
  for (const char* key : {"mean_abs_log_error", "delta_e_mean", "delta_e_p95", "sphere_flip"}) {
    if (errors.is_object() && errors.contains(key)) remarks.emplace_back(key, errors.at(key));
  }
  return remarks;
}

// "1, 0.78, 0.34"
std::string Numbers(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(FormatNumber(number));
  return Join(texts, ", ");
}

Json GltfExtensions(const Principled& p) {
  Json extensions = Json::object();
  if (!p.Is("specular", 1.0) || !p.Is("specular_color", 1.0)) {
    extensions["KHR_materials_specular"] = {{"specularFactor", p.Number("specular")},
                                            {"specularColorFactor", p.Of("specular_color")}};
  }
  if (!p.Is("anisotropy", 0.0)) {
    extensions["KHR_materials_anisotropy"] = {{"anisotropyStrength", p.Number("anisotropy")}};
  }
  if (!p.Is("coat", 0.0)) {
    extensions["KHR_materials_clearcoat"] = {
        {"clearcoatFactor", p.Number("coat")},
        {"clearcoatRoughnessFactor", p.Number("coat_roughness")}};
  }
  if (!p.Is("sheen_color", 0.0)) {
    extensions["KHR_materials_sheen"] = {{"sheenColorFactor", p.Of("sheen_color")},
                                         {"sheenRoughnessFactor", p.Number("sheen_roughness")}};
  }
  return extensions;
}

// The text as XML has it in an attribute or a comment, in which "--" isn't allowed.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '-':
        escaped += escaped.ends_with('-') ? " -" : "-";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace

std::string GltfMaterial(const AnalyticBrdf& brdf, const std::string& name) {
  const Principled p(brdf);
  std::vector<double> base = p.Of("base_color");
  base.push_back(1.0);
  Json material = {{"name", name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", base},
                     {"metallicFactor", p.Number("metallic")},
                     {"roughnessFactor", p.Number("roughness")}}}};
  Json gltf = {{"asset", {{"version", "2.0"}, {"generator", "pbnbrdf"}}}};
  if (const Json extensions = GltfExtensions(p); !extensions.empty()) {
    material["extensions"] = extensions;
    for (const auto& [extension, values] : extensions.items()) {
      gltf["extensionsUsed"].push_back(extension);
    }
  }
  Json remarks;
  for (const auto& [key, value] : Remarks(brdf)) remarks[key] = value;
  if (!remarks.is_null()) material["extras"] = {{"approximation", remarks}};
  gltf["materials"] = Json::array({material});
  return JsonText(gltf);
}

std::string MaterialX(const AnalyticBrdf& brdf, const std::string& name) {
  CheckIdentifier(name);
  const Principled p(brdf);
  std::string text =
      "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n";
  for (const auto& [key, value] : Remarks(brdf)) {
    const std::string shown = value.is_string() ? value.get<std::string>() : JsonLine(value);
    text += StrCat("  <!-- ", key, ": ", Escaped(shown), " -->\n");
  }
  text += StrCat("  <gltf_pbr name=\"", name, "_shader\" type=\"surfaceshader\">\n");
  const auto input = [&](const char* as, const char* parameter) {
    const std::vector<double>& values = p.Of(parameter);
    text += StrCat("    <input name=\"", as, "\" type=\"", values.size() == 3 ? "color3" : "float",
                   "\" value=\"", Numbers(values), "\" />\n");
  };
  input("base_color", "base_color");
  input("metallic", "metallic");
  input("roughness", "roughness");
  input("specular", "specular");
  input("specular_color", "specular_color");
  if (!p.Is("anisotropy", 0.0)) input("anisotropy_strength", "anisotropy");
  if (!p.Is("coat", 0.0)) {
    input("clearcoat", "coat");
    input("clearcoat_roughness", "coat_roughness");
  }
  if (!p.Is("sheen_color", 0.0)) {
    input("sheen_color", "sheen_color");
    input("sheen_roughness", "sheen_roughness");
  }
  return StrCat(text, "  </gltf_pbr>\n  <surfacematerial name=\"", name,
                "\" type=\"material\">\n    <input name=\"surfaceshader\" type=\"surfaceshader\" "
                "nodename=\"",
                name, "_shader\" />\n  </surfacematerial>\n</materialx>\n");
}

}  // namespace pbnbrdf
