// stages.h: how a fit proceeds: short runs from several starts, then stages on more and more samples.
#pragma once

#include "solve/training.h"

namespace pbnbrdf {

// Leaves the best of several short runs, of ScheduleOptions::starts. The first start is the training's.
void RunStarts(Training* training);

// Minimises from where the last stage ended, on the samples so far and then on more and more.
void RunStages(Training* training, int max_iterations);

}  // namespace pbnbrdf
