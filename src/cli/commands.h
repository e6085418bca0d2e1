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

// How every command that reads a material explains --material.
inline constexpr char kSourceNotes[] =
    "Sources of reflectance:\n"
    "  FILE.binary                  a table in the format of the MERL BRDF database\n"
    "  sgd:PARAMETERS.csv#MATERIAL  the shifted gamma distribution model (Bagher et al. 2012)\n"
    "  builtin:NAME                 a material that ships with the program: pbnbrdf info builtin:\n"
    "  MODEL:NAME=VALUE,...         an analytic model with its parameters, as in\n"
    "                               ggx:f0=1/0.78/0.34,alpha=0.2; pbnbrdf info models: lists them\n"
    "  FILE.json                    one that pbnbrdf fit --model wrote\n"
    "  FILE.safetensors             a network that pbnbrdf fit wrote\n"
    "  FILE.h5                      a network of NBRDF (Sztrajman et al. 2021), saved by Keras\n"
    "  BASEfc1.npy                  the same as NumPy files: BASE fc1 fc2 fc3 b1 b2 b3 .npy\n";

}  // namespace pbnbrdf::cli
