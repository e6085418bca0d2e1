// interrupt.h: lets Ctrl-C end long work early, so that its result so far is kept.
#pragma once

namespace pbnbrdf::cli {

// From now on the first Ctrl-C makes Interrupted() true; a second one ends the program.
void CatchInterrupt();

bool Interrupted();

}  // namespace pbnbrdf::cli
