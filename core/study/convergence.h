// How errors follow a setting that is a number, such as the particle spacing: lines over its values, with the
// order that they show.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/study/order.h"
#include "core/study/plan.h"
#include "core/study/table.h"

namespace migiwa {

/// Whether all values of an axis are numbers.
bool isNumeric(const StudyAxis& axis);
/// The axes along which an order can be measured: at least three values, all positive numbers.
std::vector<std::size_t> convergenceAxes(const StudyPlan& plan);

struct ConvergenceLine {
  std::string label;  ///< the values of the other axes, numbers with their names; empty if there are none
  std::vector<ValueAndError> points;
  std::optional<double> order;
};
/// One for each combination of the other axes' values. Runs without the measure, and those with an error of
/// 0, are not on it.
std::vector<ConvergenceLine> convergenceOf(const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                                           std::size_t axis, const AccuracyMeasure& measure);

}  // namespace migiwa
