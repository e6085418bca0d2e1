#include "default_materials.h"

#include <iterator>

#include "pbnbrdf/base/error.h"

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

}  // namespace

std::vector<std::string> BuiltinTexts() { return {std::begin(kBuiltins), std::end(kBuiltins)}; }

std::vector<std::string> SgdTexts() { return {std::begin(kSgdMaterials), std::end(kSgdMaterials)}; }

std::string WithSgdPath(const std::string& text, const std::string& path) {
  const std::size_t at = text.find("sgd:");
  const bool is_short = (at == 0 || (at != std::string::npos && text[at - 1] == '=')) &&
                        text.find('#') == std::string::npos;
  if (!is_short) return text;
  if (path.empty()) Fail("material '", text, "': --sgd must say where its parameters are");
  return StrCat(text.substr(0, at + 4), path, "#", text.substr(at + 4));
}

}  // namespace pbnbrdf
