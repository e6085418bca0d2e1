// pbnbrdf eval
#include <iostream>
#include <iterator>

#include "base/text.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"
#include "sources/direction_columns.h"

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
  fields.AddRequired(Text("directions", &options->directions,
                          "CSV file of pairs of directions; - is standard input"));
  fields.AddRequired(Text("out", &options->out, "CSV file to write; - is standard output"));
  return fields;
}

struct DirectionCsv {
  std::string header;
  std::vector<std::string> rows;  // as they are in the file
  std::vector<DirectionPair> pairs;
};

// The header names theta_i,phi_i,theta_o,phi_o (radians) or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z
// (normalised here) among its columns. Blank lines are skipped. Throws Error, naming `file` and the line.
DirectionCsv ParseDirectionCsv(const std::string& file, const std::string& text) {
  TextTable table(file, text, TextTable::Cells::kCommas);
  DirectionCsv csv;
  if (table.Next()) {
    csv.header = table.line();
    table.NameColumns();
  }
  const auto directions = DirectionColumns::Find(table);
  if (!directions) Fail(file, ": the first line must name the columns ", kDirectionColumns);
  while (table.Next()) {
    table.RequireCells(table.names().size());
    csv.pairs.push_back(directions->Parse(table));
    csv.rows.emplace_back(table.line());
  }
  return csv;
}

// The rows with r,g,b appended, with 17 significant digits.
std::string FormatDirectionCsv(const DirectionCsv& csv, std::span<const Rgb> values) {
  std::string text = csv.header + ",r,g,b\n";
  for (std::size_t n = 0; n < values.size(); ++n) {
    text += csv.rows[n];
    for (double value : values[n]) text += "," + FormatFullPrecision(value);
    text += "\n";
  }
  return text;
}

DirectionCsv ReadDirections(const std::string& path) {
  if (path != "-") return ParseDirectionCsv(path, ReadFile(path, kMaxFileSize));
  return ParseDirectionCsv("standard input", {std::istreambuf_iterator<char>(std::cin), {}});
}

int RunEval(const EvalOptions& options, const Arguments&) {
  CheckOutputs({{"out", options.out}});
  const std::unique_ptr<Brdf> material = options.material.Open();
  const DirectionCsv csv = ReadDirections(options.directions);
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
(radians) or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (vectors of any length); wi points to the light, wo to
the viewer. All columns are kept, and r,g,b are appended: linear RGB in 1/sr, without the cosine,
with 17 significant digits. Values are 0 where a direction isn't above the horizon.

)",
          kSourceNotes)}
      .With(EvalFields, RunEval);
}

}  // namespace pbnbrdf::cli
