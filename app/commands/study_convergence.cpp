#include "app/commands/study_convergence.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <sstream>

#include "app/commands/gnuplot.h"
#include "app/commands/study_drawing.h"
#include "app/commands/study_summary.h"
#include "core/study/convergence.h"

namespace migiwa {

namespace {

std::string orderText(const std::optional<double>& order) {
  if (!order) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", *order);
  return text;
}

/// The measures that are shown, as far as the study has them.
std::vector<AccuracyMeasure> shownMeasures(const std::vector<FinishedRun>& runs) {
  std::vector<AccuracyMeasure> shown;
  for (const AccuracyMeasure& measure : accuracyMeasures()) {
    if (measure.column != "density_error_mean" && measure.column != "height_error" &&
        measure.column != "wall_error")
      continue;
    if (std::any_of(runs.begin(), runs.end(), [&](const FinishedRun& run) {
          const std::optional<double> error = measure.error(run.record);
          return error && *error > 0;
        }))
      shown.push_back(measure);
  }
  return shown;
}

void drawPanel(std::ostream& data, std::ostream& plot, const StudyPlan& plan, std::size_t axis,
               const AccuracyMeasure& measure, const std::vector<ConvergenceLine>& lines) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double first = kInfinity, last = 0, least = kInfinity, most = 0;
  for (const ConvergenceLine& line : lines) {
    for (const auto& [value, error] : line.points) {
      first = std::min(first, value), last = std::max(last, value);
      least = std::min(least, error), most = std::max(most, error);
    }
  }
  const LogAxis x(first, last, 0.08, 0.08), y(least, most, 0.08, 0.08);
  const StudyAxis& varied = plan.axes[axis];
  plot << "set xrange [" << x.low << ':' << x.high << "]\nset yrange [" << y.low << ':' << y.high
       << "]\nset ylabel " << quotedForGnuplot(measure.title) << "\nset xtics (";
  for (std::size_t k = 0; k < varied.values.size(); ++k)
    plot << (k > 0 ? ", " : "") << quotedForGnuplot(varied.values[k]) << ' ' << varied.values[k];
  plot << ")\n" << logTicks("y", y) << "plot ";
  bool any = false;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].points.empty()) continue;
    const std::string name = "$" + measure.column + std::to_string(k);
    data << name << " << EOD\n";
    for (const auto& [value, error] : lines[k].points) data << value << ' ' << error << '\n';
    data << "EOD\n";
    plot << (any ? ", " : "") << name
         << " using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 1.1 linecolor rgb '"
         << lineColor(k) << "' title "
         << quotedForGnuplot((lines[k].label.empty() ? "" : lines[k].label + ": ") + "order " +
                             orderText(lines[k].order));
    any = true;
  }
  plot << "\nunset ytics\nset ytics\n";
}

}  // namespace

void plotConvergence(const std::filesystem::path& folder, const StudyPlan& plan,
                     const std::vector<FinishedRun>& runs) {
  const std::vector<AccuracyMeasure> measures = shownMeasures(runs);
  if (measures.empty()) return;
  for (const std::size_t axis : convergenceAxes(plan)) {
    const std::string name = plan.axes[axis].name();
    std::ostringstream data, plot;
    // The second line of the label keeps the key off it.
    plot << "set logscale xy\nset format y '%.3g'\nset xlabel \"" << name
         << "\\n \"\nset grid xtics ytics linecolor rgb '#e0e0e0'\nset key below Left reverse\nset multiplot "
            "layout 1,"
         << measures.size() << " title "
         << quotedForGnuplot("Error over " + name + ": " + plan.scene.stem().string())
         << " font 'DejaVu Sans,15'\n";
    for (const AccuracyMeasure& measure : measures)
      drawPanel(data, plot, plan, axis, measure, convergenceOf(plan, runs, axis, measure));
    plot << "unset multiplot\n";
    drawWithGnuplot(folder / ("over_" + name + ".png"),
                    "pngcairo noenhanced size 1280,640 font 'DejaVu Sans,12'", data.str() + plot.str());
  }
}

std::string convergenceSummary(const StudyPlan& plan, const std::vector<FinishedRun>& runs) {
  std::ostringstream out;
  const std::vector<AccuracyMeasure> measures = shownMeasures(runs);
  for (const std::size_t axis : convergenceAxes(plan)) {
    if (measures.empty()) break;
    out << "\n## Orders in " << plan.axes[axis].name()
        << "\n\nThe power of it that an error follows, by least squares of the logarithms.\n\n| runs |";
    for (const AccuracyMeasure& measure : measures) out << ' ' << tableCell(measure.title) << " |";
    out << "\n|---|" << (measures.size() > 1 ? "---|---|" : "---|") << '\n';
    std::vector<std::vector<ConvergenceLine>> columns;
    for (const AccuracyMeasure& measure : measures)
      columns.push_back(convergenceOf(plan, runs, axis, measure));
    for (std::size_t k = 0; k < columns.front().size(); ++k) {
      out << "| " << (columns.front()[k].label.empty() ? "all" : columns.front()[k].label) << " |";
      for (const auto& lines : columns) out << ' ' << orderText(lines[k].order) << " |";
      out << '\n';
    }
  }
  return out.str();
}

}  // namespace migiwa
