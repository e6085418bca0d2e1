// code.h: what the exports to source code share: terms as lines of a programming language, literals, texts.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/term.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// How a language writes operations; "$" stands for the operands, one after the other. + - * / and
// parentheses are the same in all of them.
struct Language {
  std::string_view statement;                 // of a name and its value
  std::array<std::string_view, 3> component;  // written after a vector for its x, y, z
  bool single_precision;                      // of its literals
  std::array<std::string_view, 9> functions;  // from Kind::kMax to kIfGreater
};

// Statements that compute all values used more than once; then, for each term, an expression of them.
struct Code {
  std::string statements;
  std::vector<std::string> values;
};

Code PrintTerms(const Language& language, const std::vector<Term>& terms);

// The expression of a term that needs no statements. Throws Error if it does.
std::string PrintExpression(const Language& language, const Term& term);

// The inputs of a network, from the vectors wi and wo.
Code PrintInputs(const Language& language, Encoding encoding);

// A floating-point literal of C, GLSL and Python that reads back as the same number: it has a point or
// an exponent.
std::string Literal(double value);
std::string Literal(float value);

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
