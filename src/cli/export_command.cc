// pbnbrdf export
#include <gflags/gflags.h>

#include "commands.h"
#include "pbnbrdf/export/export.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "shared_flags.h"

DEFINE_string(format, "", "npy | h5 | merl | csv | c | glsl | mitsuba | onnx, see below");
DEFINE_string(name, "", "of the functions of c and glsl, before _eval; as the file, if not given");

namespace pbnbrdf::cli {
namespace {

int RunExport(const std::vector<std::string>&) {
  RequireFlag("fit", FLAGS_fit);
  RequireFlag("format", FLAGS_format);
  RequireFlag("out", FLAGS_out);
  ExportFormat format;
  try {
    format = ParseName(kExportFormats, "--format", FLAGS_format);
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  CheckWritable(FLAGS_out);
  const NeuralBrdf network = OpenNetwork(FLAGS_fit);
  std::vector<FileContent> files;
  try {
    files = ExportedFiles(network, format, FLAGS_out, FLAGS_name);
  } catch (const Error& error) {
    Fail(FLAGS_fit, ", exported as ", FLAGS_format, ": ", error.what());
  }
  WriteFiles(files);
  return 0;
}

}  // namespace

Command ExportCommand() {
  Command command;
  command.name = "export";
  command.summary = "turns a fitted network into a file for a renderer, compiler or runtime";
  command.usage =
      "  pbnbrdf export --fit=gold.safetensors --format=c --out=gold.h\n"
      "  pbnbrdf export --fit=gold.safetensors --format=mitsuba --out=gold.py\n";
  command.notes =
      "Formats:\n"
      "  npy      BASEfc1.npy and fc2 fc3 b1 b2 b3, as NBRDF's Mitsuba plugin reads them; of a\n"
      "           network with relu units, two hidden layers and the cartesian encoding\n"
      "  h5       FILE.h5, a Keras file as NBRDF's are; relu units and the cartesian encoding\n"
      "  merl     FILE.binary, a table in the format of the MERL BRDF database; isotropic "
      "networks\n"
      "  csv      theta_i,phi_i,theta_o,phi_o (radians) and r,g,b on a grid of Rusinkiewicz "
      "angles\n"
      "           that is dense near the mirror direction\n"
      "  c        a C99 header with void NAME_eval(const float wi[3], const float wo[3],\n"
      "           float rgb[3]); needs <math.h> only\n"
      "  glsl     vec3 NAME_eval(vec3 wi, vec3 wo) for GLSL ES 3.00, that is WebGL 2, or later\n"
      "  mitsuba  FILE.py, which registers the BSDF \"pbnbrdf\" in Mitsuba 3, and\n"
      "           FILE_weights.safetensors\n"
      "  onnx     a model with inputs wi and wo (N x 3) and output rgb (N x 3), float32\n"
      "wi points to the light, wo to the viewer: unit vectors, normal +z. Values are linear RGB "
      "in\n"
      "1/sr, without the cosine (Mitsuba's own functions include it).\n";
  command.flags = {{"", {"fit", "format", "out", "name"}}};
  command.run = RunExport;
  return command;
}

}  // namespace pbnbrdf::cli
