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

// The format of networks, `files`, given one as a source.
template <Files (*files)(const NeuralBrdf&, const std::string&, const std::string&)>
Files OfNetwork(const Brdf& source, const std::string& path, const std::string& identifier) {
  const auto* network = dynamic_cast<const NeuralBrdf*>(&source);
  if (!network) Fail(path, ": this format holds networks only, not ", source.Description());
  return files(*network, path, identifier);
}

Files MitsubaFiles(const NeuralBrdf& network, const std::string& path, const std::string&) {
  constexpr std::string_view kPython = ".py";
  if (!path.ends_with(kPython)) Fail(path, ": a Mitsuba plugin's name ends with ", kPython);
  const std::string base = path.substr(0, path.size() - kPython.size());
  const std::string weights = base + "_weights.safetensors",
                    proposal = base + "_proposal.safetensors";
  const auto name = [](const std::string& file) {
    return std::filesystem::path(file).filename().string();
  };
  return {{weights, network.Serialized()},
          {proposal, MitsubaProposal(FitProposal(network))},
          {path, MitsubaPlugin(name(weights), name(proposal))}};
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

std::string MerlFile(const Brdf& source) { return MerlBrdf::Tabulate(source).FileBytes(); }

// A file of one text or of bytes: `content` of the source, ...
template <std::string (*content)(const Brdf&)>
Files Table(const Brdf& source, const std::string& path, const std::string&) {
  return {{path, content(source)}};
}

// ... or of a network, and of the identifier if it takes one.
template <auto content>
Files OneFile(const NeuralBrdf& network, const std::string& path, const std::string& identifier) {
  if constexpr (std::is_invocable_v<decltype(content), const NeuralBrdf&, const std::string&>) {
    return {{path, content(network, identifier)}};
  } else {
    return {{path, content(network)}};
  }
}

// ... or of a principled model and an identifier.
template <std::string (*content)(const AnalyticBrdf&, const std::string&)>
Files OfPrincipled(const Brdf& source, const std::string& path, const std::string& identifier) {
  const auto* model = dynamic_cast<const AnalyticBrdf*>(&source);
  if (!model) Fail(path, ": this format holds principled models only, not ", source.Description());
  return {{path, content(*model, identifier)}};
}

// A shader's text, with weights stored so.
template <auto source, WeightStorage storage>
std::string Shader(const NeuralBrdf& network, const std::string& identifier) {
  return source(network, identifier, storage);
}

constexpr ExportFormat kFormats[] = {
    {"npy",
     "BASEfc1.npy and fc2 fc3 b1 b2 b3, which NBRDF's Mitsuba plugin reads; the network must "
     "have relu units, two hidden layers and the cartesian encoding",
     ExportSource::kNetwork, OfNetwork<NpyFiles>},
    {"h5",
     "FILE.h5, a Keras file as NBRDF's are; the network must have relu units and the cartesian "
     "encoding",
     ExportSource::kNetwork, OfNetwork<KerasFiles>},
    {"merl", "FILE.binary, a table in the format of the MERL BRDF database, of an isotropic source",
     ExportSource::kAny, Table<MerlFile>},
    {"bsdf",
     "FILE.bsdf, tables in the format of the RGL material database, which \"measured\" of "
     "Mitsuba 3 reads in its RGB variants",
     ExportSource::kAny, Table<RglFile>},
    {"bsdf_spectral", "the same with spectra, for Mitsuba's spectral variants and pbrt-v4",
     ExportSource::kAny, Table<SpectralRglFile>},
    {"csv",
     "theta_i,phi_i,theta_o,phi_o (radians) and r,g,b on a grid of Rusinkiewicz angles that is "
     "dense near the mirror direction",
     ExportSource::kAny, Table<CsvTable>},
    {"c",
     "a C99 header with void NAME_eval(const float wi[3], const float wo[3], float rgb[3]); it "
     "needs <math.h> only",
     ExportSource::kNetwork, OfNetwork<OneFile<CSource>>},
    {"glsl", "vec3 NAME_eval(vec3 wi, vec3 wo) for GLSL ES 3.00 (WebGL 2) or later",
     ExportSource::kNetwork, OfNetwork<OneFile<Shader<GlslSource, WeightStorage::kSingle>>>},
    {"hlsl", "float3 NAME_eval(float3 wi, float3 wo) for HLSL of shader model 5 or later, or Slang",
     ExportSource::kNetwork, OfNetwork<OneFile<Shader<HlslSource, WeightStorage::kSingle>>>},
    {"wgsl", "fn NAME_eval(wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> for WGSL (WebGPU)",
     ExportSource::kNetwork, OfNetwork<OneFile<Shader<WgslSource, WeightStorage::kSingle>>>},
    {"glsl_half", "glsl with weights of half precision", ExportSource::kHalfNetwork,
     OfNetwork<OneFile<Shader<GlslSource, WeightStorage::kHalf>>>},
    {"hlsl_half", "hlsl with weights of half precision", ExportSource::kHalfNetwork,
     OfNetwork<OneFile<Shader<HlslSource, WeightStorage::kHalf>>>},
    {"wgsl_half", "wgsl with weights of half precision", ExportSource::kHalfNetwork,
     OfNetwork<OneFile<Shader<WgslSource, WeightStorage::kHalf>>>},
    {"mitsuba",
     "FILE.py, which registers the BSDF \"pbnbrdf\" in Mitsuba 3, FILE_weights.safetensors and "
     "FILE_proposal.safetensors, by which it draws directions",
     ExportSource::kNetwork, OfNetwork<MitsubaFiles>},
    {"onnx", "a model with inputs wi and wo (N x 3) and output rgb (N x 3), float32",
     ExportSource::kNetwork, OfNetwork<OneFile<OnnxModel>>},
    {"torch",
     "FILE.py with a torch.nn.Module, NAME: brdf(wi, wo), ... x 3 each, in double precision",
     ExportSource::kNetwork, OfNetwork<OneFile<TorchModule>>},
    {"gltf", "a material of glTF 2.0 with KHR extensions: the nearest principled model",
     ExportSource::kPrincipled, OfPrincipled<GltfMaterial>},
    {"materialx", "FILE.mtlx, a MaterialX document with a gltf_pbr shader: the same model",
     ExportSource::kPrincipled, OfPrincipled<MaterialX>},
};

}  // namespace

std::span<const ExportFormat> ExportFormats() { return kFormats; }

std::vector<FileContent> ExportedFiles(const Brdf& source, std::string_view format,
                                       const std::string& path, const std::string& name) {
  return FindNamed(kFormats, "format=", format)
      .files(source, path, name.empty() ? IdentifierOf(path) : name);
}

void Export(const Brdf& source, std::string_view format, const std::string& path,
            const std::string& name) {
  WriteFiles(ExportedFiles(source, format, path, name));
}

}  // namespace pbnbrdf
