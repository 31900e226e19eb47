// How the density error falls from iteration to iteration of the last step.
#pragma once

#include <span>

#include "core/simulation/frame_view.h"

namespace migiwa {

/// Fills the width of the current ImGui window; `height` is that of the plot with its labels (pixels).
void errorPlot(std::span<const IterationError> errors, double tolerance, float height);

}  // namespace migiwa
