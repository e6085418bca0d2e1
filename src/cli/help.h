// help.h: what --help shows.
#pragma once

#include <span>
#include <string>

#include "command_line.h"

namespace pbnbrdf::cli {

// The commands, a line each.
std::string OverviewText(std::span<const Command> commands);

// How to use one command. all: with every flag, not only those that people use.
std::string HelpText(const Command& command, bool all);

}  // namespace pbnbrdf::cli
