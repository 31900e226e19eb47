// Accuracy against time: a point for each setting that was tried.
#pragma once

#include <span>

#include "app/ui/what_if_panel.h"

namespace migiwa {

/// Density error (%) over milliseconds a step, both logarithmic; points bear their number from 1, and the
/// Pareto front is drawn through those that no other beats in both. Fills the width of the current ImGui
/// window.
void costChart(std::span<const WhatIfPoint> points, float height);

}  // namespace migiwa
