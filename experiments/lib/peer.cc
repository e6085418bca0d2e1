#include "peer.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/sources/nbrdf_files.h"
#include "process.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxTraceSize = 1 << 24;  // bytes
constexpr char kCheckTorch[] =
    "import importlib.util, sys; sys.exit(importlib.util.find_spec('torch') is None)";

// Where a column stands in the header.
std::size_t ColumnOf(const std::vector<std::string>& header, const std::string& name) {
  const auto column = std::find(header.begin(), header.end(), name);
  if (column == header.end()) Fail("peer's trace: has no column ", name);
  return static_cast<std::size_t>(column - header.begin());
}

}  // namespace

PeerResult ParsePeerSummary(std::string_view json) {
  const nlohmann::json summary = nlohmann::json::parse(json, nullptr, /*allow_exceptions=*/false);
  PeerResult result;
  for (const auto& [name, to] :
       {std::pair("test_loss", &result.own_error), std::pair("train_seconds", &result.seconds)}) {
    if (!summary.is_object() || !summary.contains(name) || !summary[name].is_number()) {
      Fail("peer's summary: has no number ", name);
    }
    *to = summary[name].get<double>();
  }
  result.error = result.own_error;
  return result;
}

std::vector<FitProgress> ParsePeerTrace(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = Split(line, ',');
  const std::size_t epoch = ColumnOf(header, "epoch"), seconds = ColumnOf(header, "seconds"),
                    cost = ColumnOf(header, "train_loss"), error = ColumnOf(header, "test_loss");
  std::vector<FitProgress> trace;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = Split(line, ',');
    if (cells.size() != header.size()) {
      Fail("peer's trace: a row of ", cells.size(), " cells below ", header.size(), " columns");
    }
    FitProgress progress;
    progress.iteration = static_cast<int>(ParseNumber("epoch", cells[epoch]));
    progress.seconds = ParseNumber("seconds", cells[seconds]);
    progress.cost = ParseNumber("train_loss", cells[cost]);
    progress.heldout_error = ParseNumber("test_loss", cells[error]);
    trace.push_back(progress);
  }
  return trace;
}

std::string Peer::WhyUnavailable() const {
  if (!std::filesystem::exists(script)) return StrCat(script, ": no such file");
  const int status = RunProgram({python, "-c", kCheckTorch}).status;
  if (status == 127) return StrCat(python, ": no such program");
  if (status != 0) return StrCat(python, " has no module torch");
  return "";
}

PeerResult Peer::Train(const std::string& table, const std::string& folder) const {
  const std::string trace_file = folder + "/trace.csv", weight_file = folder + "/fc1.npy";
  std::vector<std::string> arguments = {python,     script,     "--material", table,
                                        "--method", method,     "--threads",  StrCat(threads),
                                        "--trace",  trace_file, "--out",      folder};
  arguments.insert(arguments.end(), more_flags.begin(), more_flags.end());
  // It picks the linear algebra's kernels itself, unless these say otherwise.
  const ProgramResult run = RunProgram(arguments, {"OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE"});
  if (run.status != 0) Fail(script, ": ended with status ", run.status);
  PeerResult result = ParsePeerSummary(run.output);
  result.trace = ParsePeerTrace(ReadFile(trace_file, kMaxTraceSize));
  if (!std::filesystem::exists(weight_file)) return result;
  const NeuralBrdf nbrdf = ReadNbrdf(weight_file);
  const NetworkShape& shape = nbrdf.shape();
  const Encoding encoding = method == "pbnbrdf" ? Encoding::kReciprocal : shape.encoding();
  result.network.emplace(NetworkShape(encoding, shape.hidden(), shape.activation()),
                         nbrdf.weights());
  return result;
}

}  // namespace pbnbrdf
