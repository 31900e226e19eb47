// Where the time of a frame went: one bar of stages, and under it their names and milliseconds.
#pragma once

#include <imgui.h>

#include "core/base/stage_times.h"

namespace migiwa {

/// The colour of the i-th stage.
ImU32 stageColor(std::size_t i);

/// `timings` false draws the stages without their times, which differ from run to run.
void stageBar(const StageTimes& times, bool timings);

}  // namespace migiwa
