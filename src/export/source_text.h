// source_text.h: what the writers of source code share.
#pragma once

#include <array>
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

// Parts of the function that encodes a pair of directions.
struct EncoderTexts {
  std::string_view elementary;                             // functions that theta_h needs
  std::string_view half_diff;                              // the function's head; all but theta_h
  std::string_view theta_h;                                // theta_h and its scales
  std::string_view row_bend;                               // from those
  std::array<std::string_view, kEncodings.size()> inputs;  // in the order of Encoding
};

std::string EncoderText(Encoding encoding, const EncoderTexts& texts);

// The weight as float. Throws Error if it is beyond single precision.
float SinglePrecision(double weight);

}  // namespace pbnbrdf
