// source_text.h: what the writers of source code share.
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// A floating-point literal of C and GLSL that reads back as the same number: it has a point or an
// exponent.
std::string Literal(double value);
std::string Literal(float value);

// Throws Error unless it is a letter or '_', then letters, digits or '_', at most 64 of them.
void CheckIdentifier(const std::string& name);

// The text with each "@" replaced by the name.
std::string WithName(std::string_view text, const std::string& name);

// What the network is and what it was fitted to, one line of printable ASCII without "*", "\" and
// "?", which could end a comment or continue it.
std::string CommentText(const NeuralBrdf& network);

// The weight as float. Throws Error if it is beyond single precision.
float SinglePrecision(double weight);

}  // namespace pbnbrdf
