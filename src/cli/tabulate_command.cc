// pbnbrdf tabulate
#include <iostream>

#include "commands.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/sources/merl.h"
#include "shared_flags.h"

namespace pbnbrdf::cli {
namespace {

int RunTabulate(const std::vector<std::string>&) {
  CheckMaterialFlags();
  RequireFlag("out", FLAGS_out);
  CheckWritable(FLAGS_out);
  const std::unique_ptr<Brdf> material = OpenMaterial();
  AboutMaterial([&] { return MerlBrdf::Tabulate(*material); }).Write(FLAGS_out);
  return 0;
}

}  // namespace

Command TabulateCommand() {
  Command command;
  command.name = "tabulate";
  command.summary = "turns any isotropic source of reflectance into a MERL file";
  command.usage = "  pbnbrdf tabulate --material=builtin:satin-gold --out=gold.binary\n";
  command.notes = kSourceNotes;
  command.flags = {MaterialFlagsAnd({"out"})};
  command.run = RunTabulate;
  return command;
}

}  // namespace pbnbrdf::cli
