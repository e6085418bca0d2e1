// commands.h: the subcommands, each in a file of its own.
#pragma once

#include "command_line.h"

namespace pbnbrdf::cli {

Command FitCommand();
Command EvalCommand();
Command TabulateCommand();
Command ExportCommand();
Command ValuesCommand();
Command InfoCommand();
Command RenderCommand();
Command CompareCommand();

// How every command that reads a material explains --material.
inline constexpr char kSourceNotes[] =
    "Sources of reflectance:\n"
    "  FILE.binary                  a table in the format of the MERL BRDF database\n"
    "  FILE.bsdf                    a measurement of the RGL material database, RGB or spectral\n"
    "  FILE.alta, FILE.dat          measurements in the text format of ALTA\n"
    "  FILE.csv                     measurements at any directions: theta_i,phi_i,theta_o,phi_o\n"
    "                               (radians; theta_i_deg, ...: degrees) or "
    "wi_x,wi_y,wi_z,wo_x,...,\n"
    "                               and value or r,g,b: f in 1/sr. A line '# isotropic' or\n"
    "                               '# anisotropic' says which, else phi_i that differ do\n"
    "  sgd:PARAMETERS.csv#MATERIAL  the shifted gamma distribution model (Bagher et al. 2012)\n"
    "  builtin:NAME                 a material that ships with the program: pbnbrdf info builtin:\n"
    "  MODEL:NAME=VALUE,...         an analytic model with its parameters, as in\n"
    "                               ggx:f0=1/0.78/0.34,alpha=0.2; pbnbrdf info models: lists them\n"
    "  FILE.json                    one that pbnbrdf fit --model wrote\n"
    "  FILE.safetensors             a network that pbnbrdf fit wrote\n"
    "  FILE.h5                      a network of NBRDF (Sztrajman et al. 2021), saved by Keras\n"
    "  BASEfc1.npy                  the same as NumPy files: BASE fc1 fc2 fc3 b1 b2 b3 .npy\n";

}  // namespace pbnbrdf::cli
