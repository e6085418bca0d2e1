// pbnbrdf export
#include <iostream>

#include "base/about.h"
#include "command_line.h"
#include "material_options.h"
#include "model_fit.h"
#include "pbnbrdf/base/names.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/solve/half_weights.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kHelpColumn = 15;  // behind the longest name

struct ExportOptions {
  std::string fit;
  MaterialOptions material;
  const ExportFormat* format = nullptr;
  std::string out, name;
};

// "npy | h5 | ..."
std::string FormatNames() {
  std::string names;
  for (const ExportFormat& format : ExportFormats()) {
    names += StrCat(names.empty() ? "" : " | ", format.name);
  }
  return names;
}

// A format's name and help a line.
std::string FormatsHelp() {
  std::string text;
  for (const ExportFormat& format : ExportFormats()) {
    std::string name(format.name);
    name.resize(kHelpColumn, ' ');
    text += StrCat("  ", name, format.help, "\n");
  }
  return text;
}

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
        options->format = &FindNamed(ExportFormats(), "format=", text);
      },
      [options] { return std::string(options->format ? options->format->name : ""); }, [] {},
      FormatNames() + ", see below"));
  fields.AddRequired(Text("out", &options->out, "file to write; - is standard output"));
  fields.AddCommon(Text("name", &options->name,
                        "c, glsl, hlsl, wgsl: the function is called NAME_eval; torch: the class "
                        "is called NAME; by default, NAME is that of the file"));
  return fields;
}

bool HoldsNetworks(const ExportFormat& format) {
  return format.source == ExportSource::kNetwork || format.source == ExportSource::kHalfNetwork;
}

// Throws UsageError unless either a network is given or, for a table or a model, any source.
void CheckSource(const ExportOptions& options) {
  const bool has_fit = !options.fit.empty(), has_material = !options.material.source.empty();
  if (has_fit && has_material) throw UsageError("--fit and --material: give one of them only");
  if (has_fit) return;
  if (HoldsNetworks(*options.format)) {
    throw UsageError(has_material ? StrCat("--format=", options.format->name,
                                           " exports networks only: give one with --fit")
                                  : "--fit is required");
  }
  if (!has_material) throw UsageError("--fit or --material is required");
}

// For what is said of an export, which may itself be on standard output.
std::ostream& MessagesOf(const ExportOptions& options) {
  return options.out == "-" ? std::cerr : std::cout;
}

bool IsPrincipled(const Brdf& source) {
  const auto* model = dynamic_cast<const AnalyticBrdf*>(&source);
  return model != nullptr && model->model().name == "principled";
}

std::unique_ptr<Brdf> NearestPrincipled(const Brdf& source, const std::string& what,
                                        const ExportOptions& options) {
  Json errors;
  auto nearest = std::make_unique<AnalyticBrdf>(
      About(what, [&] { return PrincipledFit(source, what, &errors); }));
  MessagesOf(options) << "the nearest of its kind to " << what << ": " << nearest->Description()
                      << "\n"
                      << ErrorsText(errors);
  return nearest;
}

std::unique_ptr<Brdf> Rounded(const NeuralBrdf& network, const std::string& what,
                              const ExportOptions& options) {
  HalfWeights rounded = About(what, [&] { return ToHalfWeights(network); });
  MessagesOf(options) << what << " with weights of half precision: "
                      << rounded.network.metadata().at("half_precision") << "\n";
  return std::make_unique<NeuralBrdf>(std::move(rounded.network));
}

// The source or, where the format doesn't hold it, what is nearest to it; that is said.
std::unique_ptr<Brdf> OpenForFormat(const ExportOptions& options) {
  if (options.fit.empty()) {
    std::unique_ptr<Brdf> source = options.material.Open();
    if (options.format->source != ExportSource::kPrincipled || IsPrincipled(*source)) return source;
    return NearestPrincipled(*source, options.material.source, options);
  }
  auto network = std::make_unique<NeuralBrdf>(OpenNetwork(options.fit));
  switch (options.format->source) {
    case ExportSource::kPrincipled:
      return NearestPrincipled(*network, options.fit, options);
    case ExportSource::kHalfNetwork:
      return Rounded(*network, options.fit, options);
    default:
      return network;
  }
}

int RunExport(const ExportOptions& options, const Arguments&) {
  CheckSource(options);
  CheckOutputs({{"out", options.out}});
  const std::string& what = options.fit.empty() ? options.material.source : options.fit;
  const std::unique_ptr<Brdf> source = OpenForFormat(options);
  WriteFiles(About(StrCat(what, ", exported as ", options.format->name), [&] {
    return ExportedFiles(*source, options.format->name, options.out, options.name);
  }));
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
  pbnbrdf export --material=goniometer.csv --format=bsdf --out=gold.bsdf
  pbnbrdf export --fit=gold.safetensors --format=gltf --out=gold.gltf
)",
      .notes = StrCat(
          R"(Formats; csv, bsdf, merl, gltf and materialx are of any source (--material), the others of
networks (--fit):
)",
          FormatsHelp(),
          R"(
Weights of half precision make a shader's constants half as large; it computes in single precision.
They are rounded together, so that values mostly change by less than 0.001 (1 + f); by how much is
printed, and said in the file.

gltf and materialx hold a principled model: one that fit-model wrote, or the nearest to any other
source. How far it is from that is printed, and said in the file.

wi points to the light, wo to the viewer: unit vectors, the normal is +z. Values are linear RGB in
1/sr, without the cosine (Mitsuba's own functions include it).

)",
          kSourceNotes)}
      .With(ExportFields, RunExport);
}

}  // namespace pbnbrdf::cli
