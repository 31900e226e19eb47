// A study's pictures: error against cost, by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/study/plan.h"
#include "core/study/table.h"

namespace migiwa {

/// One measure over the wall time a simulated second, both logarithmic: a line for each value of the first
/// varied pointer, the Pareto front marked. Runs without the measure, and those with an error of exactly 0,
/// have no place there; how many is said below the title. Throws MissingError without gnuplot. Draws nothing
/// and returns false where no run has a place.
bool plotStudy(const std::filesystem::path& png, const StudyPlan& plan, const std::vector<FinishedRun>& runs,
               const AccuracyMeasure& measure);

}  // namespace migiwa
