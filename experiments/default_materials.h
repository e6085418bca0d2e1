// default_materials.h: the materials that programs of this folder fit unless they are told others.
#pragma once

#include <string>
#include <vector>

namespace pbnbrdf {

// "CLASS=builtin:NAME", for ParseMaterial (comparison.h).
std::vector<std::string> BuiltinTexts();

// "CLASS=sgd:NAME": of each class some dark, light and coloured ones.
std::vector<std::string> SgdTexts();

// A text with the path of the SGD parameters put in: "CLASS=sgd:PATH#NAME" for "CLASS=sgd:NAME".
// Others stay as they are. Throws Error if a path is needed and empty.
std::string WithSgdPath(const std::string& text, const std::string& path);

}  // namespace pbnbrdf
