// source_text.h: shared by the exports to source code.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// A floating-point literal of C, GLSL and Python that reads back as the same number: it has a point or
// an exponent.
std::string Literal(double value);
std::string Literal(float value);

// "a, b, c"
std::string ListText(const std::vector<std::string>& parts);

// The weight as float. Throws Error if it is beyond single precision.
float SinglePrecision(double weight);

// Throws Error unless it is a letter or '_', then letters, digits or '_', at most 64 of them.
void CheckIdentifier(const std::string& name);

// What the network is and what it was fitted to, one line of printable ASCII without "*", "\" and
// "?", which could end a comment or continue it.
std::string CommentText(const NeuralBrdf& network);

// The text with each @key@ replaced by its value, where it has one; values stay as they are.
std::string FillIn(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& values);

}  // namespace pbnbrdf
