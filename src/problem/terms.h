// terms.h: the terms of the cost by name, in one table.
//
// A term over samples is a functor like residuals/log_residual.h, with kName, kHelp, kDefaultWeight and
// kNeedsColor; one line in terms.cc registers it. It is differentiated by jets of the three outputs, unless
// its line names a SampleTerm of its own that is faster.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "pbnbrdf/problem/fit_problem.h"
#include "problem/sample_term.h"

namespace pbnbrdf {

struct TermType {
  std::string_view name, help;
  double default_weight;
  bool needs_color;                       // says nothing of a single channel
  std::unique_ptr<SampleTerm> (*make)();  // null: the energy term, a sum over directions
};

std::span<const TermType> TermTypes();

// Null if there is none of that name.
const TermType* FindTermType(std::string_view name);

// "log, eq. 6; chromaticity, eq. 7; energy, eq. 5"
std::string TermsHelp();

// The terms over samples among `terms`, with their weights.
struct WeightedSampleTerm {
  double weight;
  std::unique_ptr<SampleTerm> term;
};
std::vector<WeightedSampleTerm> MakeSampleTerms(const TermOptions& terms);

}  // namespace pbnbrdf
