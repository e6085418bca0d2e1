#include "pbnbrdf/export/export.h"

#include <filesystem>
#include <type_traits>

#include "export/formats.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/names.h"
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

using Files = std::vector<FileContent>;

Files MitsubaFiles(const NeuralBrdf& network, const std::string& path, const std::string&) {
  constexpr std::string_view kPython = ".py";
  if (!path.ends_with(kPython)) Fail(path, ": a Mitsuba plugin's name ends with ", kPython);
  const std::string base = path.substr(0, path.size() - kPython.size());
  const std::string weights = base + "_weights.safetensors";
  const std::string name = std::filesystem::path(weights).filename();
  return {{weights, network.Serialized()}, {path, MitsubaPlugin(name, FitLobeProposal(network))}};
}

bool IsNamedKeras(const std::string& path) {
  return path.ends_with(".h5") || path.ends_with(".hdf5");
}

Files NpyFiles(const NeuralBrdf& network, const std::string& path, const std::string&) {
  if (IsNamedKeras(path)) Fail(path, ": NumPy files are named by the first, ...fc1.npy");
  return NbrdfFiles(network, path);
}

Files KerasFiles(const NeuralBrdf& network, const std::string& path, const std::string&) {
  if (!IsNamedKeras(path)) Fail(path, ": a Keras file's name ends with .h5 or .hdf5");
  return NbrdfFiles(network, path);
}

Files MerlFiles(const NeuralBrdf& network, const std::string& path, const std::string&) {
  return {{path, MerlBrdf::Tabulate(network).FileBytes()}};
}

// A file of one text or of bytes: `content` of the network, and of the identifier if it takes one.
template <auto content>
Files OneFile(const NeuralBrdf& network, const std::string& path, const std::string& identifier) {
  if constexpr (std::is_invocable_v<decltype(content), const NeuralBrdf&, const std::string&>) {
    return {{path, content(network, identifier)}};
  } else {
    return {{path, content(network)}};
  }
}

constexpr ExportFormat kFormats[] = {
    {"npy",
     "BASEfc1.npy and fc2 fc3 b1 b2 b3, which NBRDF's Mitsuba plugin reads; the network must\n"
     "have relu units, two hidden layers and the cartesian encoding",
     NpyFiles},
    {"h5",
     "FILE.h5, a Keras file as NBRDF's are; the network must have relu units and the cartesian\n"
     "encoding",
     KerasFiles},
    {"merl",
     "FILE.binary, a table in the format of the MERL BRDF database, of an isotropic network\n"
     "(--fit) or any isotropic source of reflectance (--material)",
     MerlFiles},
    {"csv",
     "theta_i,phi_i,theta_o,phi_o (radians) and r,g,b on a grid of Rusinkiewicz angles that is\n"
     "dense near the mirror direction",
     OneFile<CsvTable>},
    {"c",
     "a C99 header with void NAME_eval(const float wi[3], const float wo[3], float rgb[3]); it\n"
     "needs <math.h> only",
     OneFile<CSource>},
    {"glsl", "vec3 NAME_eval(vec3 wi, vec3 wo) for GLSL ES 3.00 (WebGL 2) or later",
     OneFile<GlslSource>},
    {"mitsuba",
     "FILE.py, which registers the BSDF \"pbnbrdf\" in Mitsuba 3, and FILE_weights.safetensors",
     MitsubaFiles},
    {"onnx", "a model with inputs wi and wo (N x 3) and output rgb (N x 3), float32",
     OneFile<OnnxModel>},
    {"torch",
     "FILE.py with a torch.nn.Module, NAME: brdf(wi, wo), ... x 3 each, in double precision",
     OneFile<TorchModule>},
};

}  // namespace

std::span<const ExportFormat> ExportFormats() { return kFormats; }

std::vector<FileContent> ExportedFiles(const NeuralBrdf& network, std::string_view format,
                                       const std::string& path, const std::string& name) {
  return FindNamed(kFormats, "format=", format)
      .files(network, path, name.empty() ? IdentifierOf(path) : name);
}

void Export(const NeuralBrdf& network, std::string_view format, const std::string& path,
            const std::string& name) {
  WriteFiles(ExportedFiles(network, format, path, name));
}

}  // namespace pbnbrdf
