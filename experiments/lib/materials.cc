#include "materials.h"

#include <iterator>
#include <set>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/source_list.h"

namespace pbnbrdf {
namespace {

constexpr const char* kBuiltins[] = {
    "diffuse=builtin:spectralon",       "diffuse=builtin:wall-plaster",
    "diffuse=builtin:white-sand",       "glossy=builtin:white-ceramic-tile",
    "glossy=builtin:glossy-grey-paper", "glossy=builtin:ivory-computer-plastic",
    "glossy=builtin:plastic-laminate",  "glossy=builtin:blue-plastic",
    "glossy=builtin:red-satin-plastic", "metal=builtin:rough-iron",
    "metal=builtin:satin-gold",         "metal=builtin:brushed-copper",
    "metal=builtin:polished-chromium",  "metal=builtin:silver-mirror",
    "metal=builtin:brushed-aluminium",  "metal=builtin:rolled-brass"};

constexpr const char* kSgdMaterials[] = {"diffuse=sgd:white-diffuse-bball",
                                         "diffuse=sgd:polyurethane-foam",
                                         "diffuse=sgd:neoprene-rubber",
                                         "fabric=sgd:pink-felt",
                                         "fabric=sgd:beige-fabric",
                                         "fabric=sgd:red-fabric2",
                                         "fabric=sgd:dark-specular-fabric",
                                         "glossy=sgd:teflon",
                                         "glossy=sgd:nylon",
                                         "glossy=sgd:red-plastic",
                                         "glossy=sgd:yellow-matte-plastic",
                                         "glossy=sgd:specular-black-phenolic",
                                         "glossy=sgd:specular-violet-phenolic",
                                         "glossy=sgd:black-obsidian",
                                         "glossy=sgd:white-marble",
                                         "glossy=sgd:cherry-235",
                                         "paint=sgd:blue-metallic-paint",
                                         "paint=sgd:gold-metallic-paint",
                                         "paint=sgd:color-changing-paint2",
                                         "paint=sgd:dark-red-paint",
                                         "paint=sgd:light-red-paint",
                                         "paint=sgd:silver-metallic-paint2",
                                         "paint=sgd:violet-acrylic",
                                         "metal=sgd:alum-bronze",
                                         "metal=sgd:alumina-oxide",
                                         "metal=sgd:brass",
                                         "metal=sgd:chrome-steel",
                                         "metal=sgd:ss440",
                                         "metal=sgd:two-layer-silver",
                                         "metal=sgd:tungsten-carbide"};

// With the path of the SGD parameters put in: "CLASS=sgd:PATH#NAME" for "CLASS=sgd:NAME". Others stay as
// they are.
std::string WithSgdPath(const std::string& text, const std::string& path) {
  const std::size_t at = text.find("sgd:");
  const bool is_short = (at == 0 || (at != std::string::npos && text[at - 1] == '=')) &&
                        text.find('#') == std::string::npos;
  if (!is_short) return text;
  if (path.empty()) Fail("material '", text, "': --sgd must say where its parameters are");
  return StrCat(text.substr(0, at + 4), path, "#", text.substr(at + 4));
}

}  // namespace

std::vector<std::string> SgdMaterials(const std::string& sgd) {
  if (sgd.empty()) return {};
  return {std::begin(kSgdMaterials), std::end(kSgdMaterials)};
}

std::vector<std::string> ManyMaterials(const std::string& sgd) {
  std::vector<std::string> texts(std::begin(kBuiltins), std::end(kBuiltins));
  const std::vector<std::string> more = SgdMaterials(sgd);
  texts.insert(texts.end(), more.begin(), more.end());
  return texts;
}

MaterialSource ParseMaterial(const std::string& text) {
  MaterialSource material;
  const std::size_t equals = text.find('=');
  const bool has_class = equals != std::string::npos && text.find_first_of("/:.") > equals;
  if (has_class) material.material_class = text.substr(0, equals);
  material.source = has_class ? text.substr(equals + 1) : text;
  if (material.source.empty()) Fail("material '", text, "': names no source");
  material.name = NameOfSource(material.source);
  return material;
}

bool IsMeasurement(const MaterialSource& material) {
  return !material.source.starts_with("sgd:") && !material.source.starts_with("builtin:");
}

std::vector<MaterialSource> ParseMaterials(const std::vector<std::string>& arguments,
                                           const std::vector<std::string>& defaults,
                                           const std::string& sgd) {
  std::vector<std::string> texts;
  for (const std::string& argument : arguments) {
    if (argument == "default") {
      texts.insert(texts.end(), defaults.begin(), defaults.end());
    } else {
      texts.push_back(argument);
    }
  }
  std::vector<MaterialSource> materials;
  std::set<std::string> names;
  for (const std::string& text : arguments.empty() ? defaults : texts) {
    materials.push_back(ParseMaterial(WithSgdPath(text, sgd)));
    const std::string& name = materials.back().name;
    OpenBrdf(materials.back().source);
    if (!names.insert(name).second) Fail("material '", text, "': another one is named ", name);
  }
  return materials;
}

}  // namespace pbnbrdf
