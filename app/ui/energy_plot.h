// The energy of the fluid over the run, against what was given to it.
#pragma once

#include <span>

#include "core/simulation/energy_balance.h"

namespace migiwa {

/// Fills the width of the current ImGui window; `height` is that of the plot with its labels (pixels).
/// Heights count from the energy of the start.
void energyPlot(std::span<const EnergySample> samples, float height);

}  // namespace migiwa
