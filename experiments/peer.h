// peer.h: another implementation to compare with: a program that fits a MERL table.
//
// It is run as
//
//   PYTHON SCRIPT --material TABLE.binary --method METHOD --threads N --trace FILE.csv
//
// prints a JSON object with test_loss (the mean absolute log error, eq. 6, on its held-out samples)
// and train_seconds, and writes the columns epoch, seconds, train_loss and test_loss.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {

// Its network's hidden layers, as HiddenName has them.
inline constexpr char kPeerHidden[] = "21-21";

struct PeerResult {
  double seconds = 0.0, error = 0.0;  // of the whole training; at its end
  std::vector<FitProgress> trace;     // an iteration is an epoch, the cost its training loss
};

// Each throws Error unless the text is as described above.
PeerResult ParsePeerSummary(std::string_view json);  // without the trace
std::vector<FitProgress> ParsePeerTrace(const std::string& csv);

struct Peer {
  std::string python, script, method;
  int threads = 2;
  std::vector<std::string> more_flags;

  // "" or, in a sentence, why it can't be run.
  std::string WhyUnavailable() const;

  // Trains on a MERL file. Throws Error if that fails. trace_file: to be written.
  PeerResult Train(const std::string& table, const std::string& trace_file) const;
};

}  // namespace pbnbrdf
