// pbnbrdf export
#include "base/about.h"
#include "base/text.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/base/names.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kHelpColumn = 9;  // behind the longest name

struct ExportOptions {
  std::string fit;
  MaterialOptions material;
  std::string format;
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

// A format's name and help a line, further lines indented.
std::string FormatsHelp() {
  std::string text;
  for (const ExportFormat& format : ExportFormats()) {
    std::string name(format.name);
    for (const std::string& line : Split(format.help, '\n')) {
      name.resize(kHelpColumn, ' ');
      text += StrCat("  ", name, line, "\n");
      name.clear();
    }
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
        options->format = FindNamed(ExportFormats(), "format=", text).name;
      },
      [options] { return options->format; }, [] {}, FormatNames() + ", see below"));
  fields.AddRequired(Text("out", &options->out, "file to write; - is standard output"));
  fields.AddCommon(Text("name", &options->name,
                        "c, glsl: the function is called NAME_eval; torch: the class is called "
                        "NAME; by default, NAME is that of the file"));
  return fields;
}

// Throws UsageError unless either a network is given or, for a MERL table, any source.
void CheckSource(const ExportOptions& options) {
  const bool has_fit = !options.fit.empty(), has_material = !options.material.source.empty();
  if (has_fit && has_material) throw UsageError("--fit and --material: give one of them only");
  if (has_fit) return;
  if (options.format != "merl") {
    throw UsageError(has_material ? StrCat("--format=", options.format,
                                           " exports networks only: give one with --fit")
                                  : "--fit is required");
  }
  if (!has_material) throw UsageError("--fit or --material is required");
}

std::vector<FileContent> NetworkFiles(const ExportOptions& options) {
  const NeuralBrdf network = OpenNetwork(options.fit);
  return About(StrCat(options.fit, ", exported as ", options.format),
               [&] { return ExportedFiles(network, options.format, options.out, options.name); });
}

int RunExport(const ExportOptions& options, const Arguments&) {
  CheckSource(options);
  CheckOutputs({{"out", options.out}});
  if (!options.fit.empty()) {
    WriteFiles(NetworkFiles(options));
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
      .notes = StrCat(
          R"(Formats:
)",
          FormatsHelp(),
          R"(wi points to the light, wo to the viewer: unit vectors, the normal is +z. Values are linear RGB in
1/sr, without the cosine (Mitsuba's own functions include it).

)",
          kSourceNotes)}
      .With(ExportFields, RunExport);
}

}  // namespace pbnbrdf::cli
