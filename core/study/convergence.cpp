#include "core/study/convergence.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace migiwa {

namespace {

/// NaN for what is no number.
double numberOf(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' ? number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

bool isNumeric(const StudyAxis& axis) {
  return std::all_of(axis.values.begin(), axis.values.end(),
                     [](const std::string& value) { return !std::isnan(numberOf(value)); });
}

std::vector<std::size_t> convergenceAxes(const StudyPlan& plan) {
  std::vector<std::size_t> axes;
  for (std::size_t k = 0; k < plan.axes.size(); ++k) {
    const std::vector<std::string>& values = plan.axes[k].values;
    if (values.size() >= 3 && std::all_of(values.begin(), values.end(),
                                          [](const std::string& value) { return numberOf(value) > 0; }))
      axes.push_back(k);
  }
  return axes;
}

std::vector<ConvergenceLine> convergenceOf(const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                                           std::size_t axis, const AccuracyMeasure& measure) {
  std::vector<ConvergenceLine> lines;
  for (const FinishedRun& run : runs) {
    std::string label;
    for (std::size_t k = 0; k < plan.axes.size(); ++k)
      if (k != axis)
        label += (label.empty() ? "" : ", ") + (isNumeric(plan.axes[k]) ? plan.axes[k].name() + " " : "") +
                 plan.axes[k].label(run.values[k]);
    auto line =
        std::find_if(lines.begin(), lines.end(), [&](const auto& known) { return known.label == label; });
    if (line == lines.end()) line = lines.insert(lines.end(), {label, {}, {}});
    const std::optional<double> error = measure.error(run.record);
    if (error && *error > 0) line->points.push_back({numberOf(run.values[axis]), *error});
  }
  for (ConvergenceLine& line : lines) line.order = measuredOrder(line.points);
  return lines;
}

}  // namespace migiwa
