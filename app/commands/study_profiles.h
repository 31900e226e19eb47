// What a study shows of the runs themselves rather than of one number for each: the pressure in the water
// over its depth against rho0 g z, and the energy that the solver has added over time against its bound,
// none.
#pragma once

#include <filesystem>
#include <vector>

#include "core/study/plan.h"
#include "core/study/table.h"

namespace migiwa {

/// pressure_profile.png and energy.png, one line for each value of the first varied pointer: of its last run
/// that has such a profile. Leaves out a picture that would be empty. Throws MissingError without gnuplot.
void plotProfiles(const std::filesystem::path& folder, const StudyPlan& plan,
                  const std::vector<FinishedRun>& runs);

}  // namespace migiwa
