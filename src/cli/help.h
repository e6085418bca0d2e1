// help.h: what the program says of itself.
#pragma once

#include <span>
#include <string>

#include "command_line.h"

namespace pbnbrdf::cli {

// The commands, a line each.
std::string OverviewText(std::span<const Command> commands);

// How to use one command. all: with every flag, not only those that people use.
std::string HelpText(const Command& command, bool all);

// All of it as a page for `man`, section 1 (troff, macros of man(7)).
std::string ManualPage(std::span<const Command> commands);

// A script that makes bash complete commands, flags, and those values of which there are a few.
std::string BashCompletion(std::span<const Command> commands);

}  // namespace pbnbrdf::cli
