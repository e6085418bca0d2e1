// code.h: terms as lines of a programming language.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "export/term.h"
#include "pbnbrdf/network/network_shape.h"

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

}  // namespace pbnbrdf
