// interrupt.h: Ctrl-C stops long work after a step and keeps what there is so far.
#pragma once

namespace pbnbrdf::cli {

// From now on the first Ctrl-C sets Interrupted(); a second one ends the program.
void CatchInterrupt();

bool Interrupted();

}  // namespace pbnbrdf::cli
