// How a study's errors follow its settings that are numbers: pictures by gnuplot, and words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/study/plan.h"
#include "core/study/table.h"

namespace migiwa {

/// Draws FOLDER/over_NAME.png for each axis along which an order can be measured: the mean density error over
/// its values and, where there is one, the error of the settled height, logarithmic, a line for each
/// combination of the other values with its order. Throws MissingError without gnuplot.
void plotConvergence(const std::filesystem::path& folder, const StudyPlan& plan,
                     const std::vector<FinishedRun>& runs);

/// The same orders as Markdown tables; empty where there is no such axis.
std::string convergenceSummary(const StudyPlan& plan, const std::vector<FinishedRun>& runs);

}  // namespace migiwa
