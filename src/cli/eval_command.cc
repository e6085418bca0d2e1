// pbnbrdf values
#include <gflags/gflags.h>

#include <iostream>
#include <iterator>
#include <sstream>

#include "commands.h"
#include "direction_csv.h"
#include "pbnbrdf/base/files.h"
#include "shared_flags.h"

DEFINE_string(directions, "", "CSV of direction pairs; - is standard input");

namespace pbnbrdf::cli {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

std::string ReadText(const std::string& path) {
  if (path != "-") return ReadFile(path, kLargestFile);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

int RunValues(const std::vector<std::string>&) {
  CheckMaterialFlags();
  RequireFlag("directions", FLAGS_directions);
  RequireFlag("out", FLAGS_out);
  CheckWritable(FLAGS_out);
  const std::unique_ptr<Brdf> material = OpenMaterial();
  const DirectionCsv csv = ParseDirectionCsv(
      FLAGS_directions == "-" ? "standard input" : FLAGS_directions, ReadText(FLAGS_directions));
  std::vector<Rgb> values(csv.pairs.size());
  material->Evaluate(csv.pairs, values);
  WriteFile(FLAGS_out, FormatDirectionCsv(csv, values));
  return 0;
}

}  // namespace

Command ValuesCommand() {
  Command command;
  command.name = "values";
  command.summary = "evaluates any source of reflectance at the direction pairs of a CSV";
  command.usage =
      "  pbnbrdf values --material=gold.safetensors --directions=pairs.csv --out=values.csv\n";
  command.notes =
      "The CSV's first line names its columns: theta_i,phi_i,theta_o,phi_o (radians; wi points to\n"
      "the light) or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (any length), among others, which are kept. "
      "The\n"
      "columns r,g,b are appended: linear RGB in 1/sr, without the cosine, 17 significant digits; "
      "0\n"
      "where a direction isn't above the horizon.\n\n" +
      std::string(kSourceNotes);
  command.flags = {MaterialFlagsAnd({"directions", "out"})};
  command.run = RunValues;
  return command;
}

}  // namespace pbnbrdf::cli
