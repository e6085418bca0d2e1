// materials.h: the materials that a program fits.
#pragma once

#include <string>
#include <vector>

namespace pbnbrdf {

// "CLASS=SOURCE" or "SOURCE", a source as OpenBrdf reads it.
struct MaterialSource {
  std::string name;            // "chrome-steel" of "sgd:parameters.csv#chrome-steel"
  std::string material_class;  // "" if none is given
  std::string source;
};

MaterialSource ParseMaterial(const std::string& text);

// Whether it is neither a built-in material nor one of the SGD model: these go by names of measured materials, whose
// published networks aren't theirs.
bool IsMeasurement(const MaterialSource& material);

// The materials that a program's arguments name or, if there are none, the defaults; the argument
// "default" stands for all of these. sgd: a CSV of SGD parameters, which "sgd:NAME" stands for a material
// of, or "". Opens each, so that a mistake shows before the first fit. Throws Error, also if two have the
// same name.
std::vector<MaterialSource> ParseMaterials(const std::vector<std::string>& arguments,
                                           const std::vector<std::string>& defaults,
                                           const std::string& sgd);

// Built-in materials and, unless sgd is "", 30 of the SGD model: of each class some dark, light and
// coloured ones.
std::vector<std::string> ManyMaterials(const std::string& sgd);

// The 30 alone; none if sgd is "".
std::vector<std::string> SgdMaterials(const std::string& sgd);

// Below the usage of each program that takes them.
inline constexpr char kMaterialsHelp[] = R"(
A material is anything that 'pbnbrdf fit --material' takes, with CLASS= in front of it if wanted;
sgd:NAME is a material of --sgd; default stands for all default materials.
)";
inline constexpr char kSgdHelp[] =
    "CSV of parameters of the SGD model (shifted gamma distribution), whose materials are "
    "'sgd:NAME'";

}  // namespace pbnbrdf
