// Reports side by side, for a person to read.
#pragma once

#include <string>
#include <vector>

#include "core/io/report.h"

namespace migiwa {

/// An aligned table: a row for each measure with its unit, a column for each report. `labels` head the
/// columns; without them there is no heading.
std::string reportTable(const std::vector<Report>& reports, const std::vector<std::string>& labels = {});

}  // namespace migiwa
