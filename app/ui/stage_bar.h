// Where the time of a frame went: one bar of stages, and under it their names and milliseconds.
#pragma once

#include "core/base/stage_times.h"

namespace migiwa {

/// `timings` false draws the stages without their times, which differ from run to run.
void stageBar(const StageTimes& times, bool timings);

}  // namespace migiwa
