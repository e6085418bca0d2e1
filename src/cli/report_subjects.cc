#include "report_subjects.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/text.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "sources/source_list.h"

namespace pbnbrdf::cli {
namespace {

constexpr char kNetwork[] = ".safetensors";
constexpr std::uintmax_t kMaxSummaryBytes = std::uintmax_t{1} << 26;

std::vector<std::string> NetworksIn(const std::string& folder) {
  std::error_code code;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
    if (entry.path().extension() == kNetwork) files.push_back(entry.path());
  }
  if (code) Fail("--fits=", folder, ": ", code.message());
  if (files.empty()) Fail("--fits=", folder, ": has no fits, NAME", kNetwork);
  std::sort(files.begin(), files.end());
  return files;
}

std::string Entry(const NeuralBrdf::Metadata& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  return found == metadata.end() ? "" : found->second;
}

// In quotes where a shell would take it for more than a word.
std::string ShellWord(const std::string& text) {
  if (text.find_first_of(" \t;#*?[]()<>|&$'\"\\`!~{}") == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// From the flags that the file records, a line each.
std::string CommandFrom(const std::string& flags, const std::string& file) {
  if (flags.empty()) return "";
  std::string command = "pbnbrdf fit";
  std::istringstream in(flags);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) command += StrCat(" ", ShellWord(line));
  }
  return StrCat(command, " --out=", ShellWord(std::filesystem::path(file).filename()));
}

// What `fit` wrote beside the network, or what the user names. Null if there is none.
Json SummaryOf(const std::string& network, const std::string& named) {
  const std::string beside = std::filesystem::path(network).replace_extension(".json");
  if (named.empty() && (beside == network || !std::filesystem::exists(beside))) return nullptr;
  const std::string& file = named.empty() ? beside : named;
  Json json = ParseJson(ReadFile(file, kMaxSummaryBytes));
  if (json.is_object() && json.contains("history")) return json;
  if (named.empty()) return nullptr;
  Fail(file, ": not a summary that pbnbrdf fit --summary wrote: it has no history");
}

NeuralBrdf::Metadata MetadataOf(const std::string& file) {
  if (!file.ends_with(kNetwork)) return {};
  return NeuralBrdf::Read(file).metadata();
}

FitOfMaterial FitIn(const std::string& file, const ReportOptions& options) {
  const NeuralBrdf::Metadata metadata = MetadataOf(file);
  const std::string fitted_to = Entry(metadata, "material");
  FitOfMaterial fit = {NameOfSource(file), file, options.material,
                       CommandFrom(Entry(metadata, "problem"), file),
                       SummaryOf(file, options.summary)};
  std::string& source = fit.material.source;
  if (source.empty()) {
    if (fitted_to.empty()) Fail(file, ": doesn't say what it was fitted to; --material is needed");
    source = fitted_to;
  } else if (!fitted_to.empty() && NameOfSource(source) != NameOfSource(fitted_to) &&
             !options.any_material) {
    Fail(file, ": was fitted to ", fitted_to, ", not to ", source,
         "; --any_material shows them together all the same");
  }
  const std::string scale = Entry(metadata, "scale_to_albedo");
  if (fit.material.scale_to_albedo == 0.0 && !scale.empty()) {
    fit.material.scale_to_albedo = ParseNumber(file + ": scale_to_albedo", scale);
  }
  return fit;
}

}  // namespace

std::vector<FitOfMaterial> FindFits(const ReportOptions& options) {
  if (options.fit.empty() == options.fits.empty()) {
    throw UsageError("--fit=FILE or --fits=DIR is required");
  }
  if (!options.fits.empty() && !(options.material.source.empty() && options.summary.empty())) {
    throw UsageError(
        "--material and --summary are for --fit; with --fits the files name the materials");
  }
  std::vector<FitOfMaterial> fits;
  const std::vector<std::string> files =
      options.fits.empty() ? std::vector{options.fit} : NetworksIn(options.fits);
  for (const std::string& file : files) fits.push_back(FitIn(file, options));
  return fits;
}

}  // namespace pbnbrdf::cli
