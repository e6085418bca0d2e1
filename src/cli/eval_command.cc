// pbnbrdf eval
#include <iostream>
#include <iterator>

#include "command_line.h"
#include "direction_csv.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::uintmax_t kMaxFileSize = std::uintmax_t{4} << 30;  // bytes: some 50 million pairs

struct EvalOptions {
  MaterialOptions material;
  std::string directions, out;
};

Fields EvalFields(EvalOptions* options) {
  Fields fields;
  fields.AddRequired(MaterialField(&options->material));
  fields.AddCommon(ScaleField(&options->material));
  fields.AddCommon(SymmetrizeField(&options->material.symmetrize));
  fields.AddRequired(Text("directions", &options->directions,
                          "CSV file of pairs of directions; - is standard input"));
  fields.AddRequired(Text("out", &options->out, "CSV file to write; - is standard output"));
  return fields;
}

DirectionCsv ReadDirections(const std::string& path) {
  if (path != "-") return ParseDirectionCsv(path, ReadFile(path, kMaxFileSize));
  return ParseDirectionCsv("standard input", {std::istreambuf_iterator<char>(std::cin), {}});
}

int RunEval(const EvalOptions& options, const Arguments&) {
  CheckOutputs({{"out", options.out}});
  const std::unique_ptr<Brdf> material = options.material.Open();
  const DirectionCsv csv = ReadDirections(options.directions);
  if (csv.left_out > 0) {
    std::cerr << "pbnbrdf: " << csv.left_out << " rows that lack a direction are left out\n";
  }
  std::vector<Rgb> values(csv.pairs.size());
  material->Evaluate(csv.pairs, values);
  WriteFile(options.out, FormatDirectionCsv(csv, values));
  return 0;
}

}  // namespace

Command EvalCommand() {
  return Command{
      .name = "eval",
      .summary = "evaluates any source of reflectance at the pairs of directions in a CSV file",
      .usage = R"(  pbnbrdf eval --material=gold.safetensors --directions=pairs.csv --out=values.csv
)",
      .notes = StrCat(
          R"(The first line of the CSV file names its columns. They must include theta_i,phi_i,theta_o,phi_o
(radians; theta_i_deg, ...: degrees) or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (vectors of any length); wi
points to the light, wo to the viewer; a negative theta is on the other side of the normal. Columns
are separated by commas, semicolons, tabs or blanks. All are kept, and r,g,b are appended: linear
RGB in 1/sr, without the cosine, with 17 significant digits. Values are 0 where a direction isn't
above the horizon. Rows that lack a direction are left out.

)",
          kSourceNotes)}
      .With(EvalFields, RunEval);
}

}  // namespace pbnbrdf::cli
