// commands.h: the subcommands, each in a file of its own.
#pragma once

#include "command_line.h"

namespace pbnbrdf::cli {

Command CompareCommand();
Command EvalCommand();
Command ExportCommand();
Command FitCommand();
Command FitModelCommand();
Command InfoCommand();
Command MeasureCommand();

// With the render module only.
Command FitSceneCommand();
Command RenderCommand();

}  // namespace pbnbrdf::cli
