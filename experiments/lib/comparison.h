// comparison.h: fits of several solvers beside the peer's, as tables and curves.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "curves.h"
#include "figure.h"
#include "peer.h"
#include "table.h"

namespace pbnbrdf {

// One fit of a solver to a material.
struct FitRecord {
  std::string material, solver, hidden;
  int seed = 0;
  std::vector<FitProgress> trace;
  double seconds = 0.0, error = 0.0;  // of the whole fit; at its end, on many held-out samples
};

// By the material's name.
using PeerRecords = std::map<std::string, PeerResult>;

Curve ErrorCurve(const std::vector<FitProgress>& trace);

// A fit compared with the peer's of the same material.
struct Versus {
  double seconds_to_error;   // until the error is at most the peer's last one; infinite if never
  double times_as_fast;      // the peer's seconds over these
  double error_then;         // when the peer's training ended; infinite if the fit had no error yet
  double times_as_accurate;  // the peer's error over this one
};

Versus Compare(const FitRecord& fit, const PeerResult& peer);

// For each network and solver a table with a row for each material, the median of its seeds, and
// below these the median of the materials and the worst of all fits; at the end these two for each
// network and solver. Without records of the peer its columns are left out.
std::string ComparisonMarkdown(const std::vector<FitRecord>& fits, const PeerRecords& peers);

// For each network a panel with the median curve of each solver, and of the peer.
Figure ComparisonFigure(const std::vector<FitRecord>& fits, const PeerRecords& peers);

}  // namespace pbnbrdf
