// pbnbrdf export
#include "base/about.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {
namespace {

struct ExportOptions {
  std::string fit;
  MaterialOptions material;
  std::string format;
  std::string out, name;
};

Fields ExportFields(ExportOptions* options) {
  Fields fields;
  fields.AddCommon(
      Text("fit", &options->fit, "fitted network (.safetensors, or NBRDF's .h5 or fc1.npy)"));
  fields.AddCommon(MaterialField(&options->material));
  fields.AddCommon(ScaleField(&options->material));
  fields.AddCommon(SymmetrizeField(&options->material.symmetrize));
  fields.AddRequired(Custom(
      "format",
      [options](std::string_view text) {
        ParseName(kExportFormats, "format", text);
        options->format = text;
      },
      [options] { return options->format; }, [] {}, JoinNames(kExportFormats) + ", see below"));
  fields.AddRequired(Text("out", &options->out, "file to write; - is standard output"));
  fields.AddCommon(Text("name", &options->name,
                        "c and glsl: the function is called NAME_eval; as the file, if not given"));
  return fields;
}

// Throws UsageError unless either a network is given or, for a MERL table, any source.
void CheckSource(const ExportOptions& options, ExportFormat format) {
  const bool has_fit = !options.fit.empty(), has_material = !options.material.source.empty();
  if (has_fit && has_material) throw UsageError("--fit and --material: give one of them only");
  if (has_fit) return;
  if (format != ExportFormat::kMerl) {
    throw UsageError(has_material ? StrCat("--format=", options.format,
                                           " exports networks only: give one with --fit")
                                  : "--fit is required");
  }
  if (!has_material) throw UsageError("--fit or --material is required");
}

std::vector<FileContent> NetworkFiles(const ExportOptions& options, ExportFormat format) {
  const NeuralBrdf network = OpenNetwork(options.fit);
  return About(StrCat(options.fit, ", exported as ", options.format),
               [&] { return ExportedFiles(network, format, options.out, options.name); });
}

int RunExport(const ExportOptions& options, const Arguments&) {
  const ExportFormat format = ParseName(kExportFormats, "format", options.format);
  CheckSource(options, format);
  CheckOutputs({{"out", options.out}});
  if (!options.fit.empty()) {
    WriteFiles(NetworkFiles(options, format));
    return 0;
  }
  const std::unique_ptr<Brdf> material = options.material.Open();
  About(options.material.source, [&] { return MerlBrdf::Tabulate(*material); }).Write(options.out);
  return 0;
}

}  // namespace

Command ExportCommand() {
  return Command{
      .name = "export",
      .summary = "writes a fit, or any source of reflectance, as a file for other programs",
      .usage = R"(  pbnbrdf export --fit=gold.safetensors --format=c --out=gold.h
  pbnbrdf export --fit=gold.safetensors --format=mitsuba --out=gold.py
  pbnbrdf export --material=builtin:satin-gold --format=merl --out=gold.binary
)",
      .notes = StrCat(R"(Formats:
  npy      BASEfc1.npy and fc2 fc3 b1 b2 b3, which NBRDF's Mitsuba plugin reads; the network must
           have relu units, two hidden layers and the cartesian encoding
  h5       FILE.h5, a Keras file as NBRDF's are; the network must have relu units and the cartesian
           encoding
  merl     FILE.binary, a table in the format of the MERL BRDF database, of an isotropic network
           (--fit) or any isotropic source of reflectance (--material)
  csv      theta_i,phi_i,theta_o,phi_o (radians) and r,g,b on a grid of Rusinkiewicz angles that is
           dense near the mirror direction
  c        a C99 header with void NAME_eval(const float wi[3], const float wo[3], float rgb[3]); it
           needs <math.h> only
  glsl     vec3 NAME_eval(vec3 wi, vec3 wo) for GLSL ES 3.00 (WebGL 2) or later
  mitsuba  FILE.py, which registers the BSDF "pbnbrdf" in Mitsuba 3, and FILE_weights.safetensors
  onnx     a model with inputs wi and wo (N x 3) and output rgb (N x 3), float32
wi points to the light, wo to the viewer: unit vectors, the normal is +z. Values are linear RGB in
1/sr, without the cosine (Mitsuba's own functions include it).

)",
                      kSourceNotes)}
      .With(ExportFields, RunExport);
}

}  // namespace pbnbrdf::cli
