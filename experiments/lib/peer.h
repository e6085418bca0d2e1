// peer.h: runs another implementation, to compare with: a program that fits a MERL table.
//
// It is run as
//
//   PYTHON SCRIPT --material TABLE.binary --method METHOD --threads N --trace FILE.csv --out FOLDER
//
// prints a JSON object with test_loss (the mean absolute log error, eq. 6, on its held-out samples)
// and train_seconds, and writes the columns epoch, seconds, train_loss and test_loss, and its network
// as FOLDER/fc1.npy and so on (nbrdf_files.h), of method pbnbrdf for the reciprocal encoding.
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
  double seconds = 0.0;               // of the whole training
  double own_error = 0.0;             // at its end, on its own held-out samples
  double error = 0.0;                 // on ours, where its network has been measured, or the same
  std::vector<FitProgress> trace;     // an iteration is an epoch, the cost its training loss
  std::optional<NeuralBrdf> network;  // if it writes one
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

  // Trains on a MERL file. Throws Error if that fails. folder: to be written to.
  PeerResult Train(const std::string& table, const std::string& folder) const;
};

}  // namespace pbnbrdf
