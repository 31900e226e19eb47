// A study in words, as Markdown.
#pragma once

#include <string>
#include <vector>

#include "core/study/plan.h"
#include "core/study/table.h"

namespace migiwa {

/// Text for a cell of a Markdown table, where bars end a cell.
std::string tableCell(const std::string& text);

/// Which runs are on the front of each measure, what the best accuracy costs, and how far times scatter.
std::string studySummary(const StudyPlan& plan, const std::vector<FinishedRun>& runs);

}  // namespace migiwa
