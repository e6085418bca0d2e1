#include "pbnbrdf/export/export.h"

#include <filesystem>

#include "export/formats.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/nbrdf_files.h"

namespace pbnbrdf {
namespace {

// The file's name up to its first dot, as an identifier: gold-paint.v2.h -> gold_paint.
std::string IdentifierOf(const std::string& path) {
  const std::string file = std::filesystem::path(path).filename();
  std::string name = file.substr(0, file.find('.'));
  for (char& c : name) {
    const bool fits =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!fits) c = '_';
  }
  return name;
}

std::vector<FileContent> MitsubaFiles(const NeuralBrdf& network, const std::string& path) {
  constexpr std::string_view kPython = ".py";
  if (!path.ends_with(kPython)) Fail(path, ": a Mitsuba plugin's name ends with ", kPython);
  const std::string base = path.substr(0, path.size() - kPython.size());
  const std::string weights = base + "_weights.safetensors";
  const std::string name = std::filesystem::path(weights).filename();
  return {{weights, network.Serialized()}, {path, MitsubaPlugin(name, FitLobeProposal(network))}};
}

std::vector<FileContent> NbrdfFilesOf(const NeuralBrdf& network, const std::string& path,
                                      bool keras) {
  const bool named_keras = path.ends_with(".h5") || path.ends_with(".hdf5");
  if (keras && !named_keras) Fail(path, ": a Keras file's name ends with .h5 or .hdf5");
  if (!keras && named_keras) Fail(path, ": NumPy files are named by the first, ...fc1.npy");
  return NbrdfFiles(network, path);
}

}  // namespace

std::vector<FileContent> ExportedFiles(const NeuralBrdf& network, ExportFormat format,
                                       const std::string& path, const std::string& name) {
  const std::string identifier = name.empty() ? IdentifierOf(path) : name;
  switch (format) {
    case ExportFormat::kNpy:
    case ExportFormat::kH5:
      return NbrdfFilesOf(network, path, format == ExportFormat::kH5);
    case ExportFormat::kMerl:
      return {{path, MerlBrdf::Tabulate(network).FileBytes()}};
    case ExportFormat::kCsv:
      return {{path, CsvTable(network)}};
    case ExportFormat::kC:
      return {{path, CSource(network, identifier)}};
    case ExportFormat::kGlsl:
      return {{path, GlslSource(network, identifier)}};
    case ExportFormat::kMitsuba:
      return MitsubaFiles(network, path);
    case ExportFormat::kOnnx:
      return {{path, OnnxModel(network)}};
  }
  return {};
}

void Export(const NeuralBrdf& network, ExportFormat format, const std::string& path,
            const std::string& name) {
  WriteFiles(ExportedFiles(network, format, path, name));
}

}  // namespace pbnbrdf
