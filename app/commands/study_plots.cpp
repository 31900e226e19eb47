#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <sstream>

#include "app/commands/plots.h"
#include "core/study/study.h"

namespace migiwa {

namespace {

constexpr const char* kTerminal = "pngcairo noenhanced size 1280,720 font 'DejaVu Sans,13'";

using Curve = std::vector<std::pair<double, double>>;
using CurveOf = std::function<Curve(const RunRecord&)>;

struct Picture {
  std::string title;
  std::string settings;  ///< gnuplot's, before the curves
  CurveOf curve;         ///< of a run
  Curve bound;           ///< what they are compared with; empty: nothing
  std::string boundTitle;
};

/// The last valid run of each value of the first axis that has a curve.
std::vector<const FinishedRun*> shownRuns(const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                                          const CurveOf& curve) {
  std::vector<const FinishedRun*> shown;
  for (const std::string& value : plan.axes.front().values) {
    const FinishedRun* last = nullptr;
    for (const FinishedRun& run : runs)
      if (run.values.front() == value && run.record.trouble.empty() && !curve(run.record).empty())
        last = &run;
    if (last != nullptr) shown.push_back(last);
  }
  return shown;
}

void draw(const std::filesystem::path& png, const StudyPlan& plan, const std::vector<FinishedRun>& runs,
          const Picture& picture) {
  const std::vector<const FinishedRun*> shown = shownRuns(plan, runs, picture.curve);
  if (shown.empty()) return;
  std::ostringstream data, plot;
  const auto block = [&](const std::string& name, const Curve& curve) {
    data << name << " << EOD\n";
    for (const auto& [x, y] : curve) data << x << ' ' << y << '\n';
    data << "EOD\n";
  };
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::string name = "$run" + std::to_string(k);
    block(name, picture.curve(shown[k]->record));
    plot << (k > 0 ? ", " : "") << name
         << " using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.5 linecolor rgb '"
         << lineColor(k) << "' title " << quotedForGnuplot(plan.axes.front().label(shown[k]->values.front()));
  }
  if (!picture.bound.empty()) {
    block("$bound", picture.bound);
    plot << ", $bound using 1:2 with lines linewidth 2 dashtype 2 linecolor rgb 'black' title "
         << quotedForGnuplot(picture.boundTitle);
  }
  std::ostringstream script;
  script
      << data.str() << "set title "
      << quotedForGnuplot(picture.title + ": " + plan.scene.stem().string() +
                          (plan.axes.size() > 1 ? ", " + plan.describe(shown.front()->values, 1) : ""))
      << " font 'DejaVu Sans,15'\nset grid linecolor rgb '#e0e0e0'\nset key outside right top Left reverse\n"
      << picture.settings << "plot " << plot.str() << '\n';
  drawWithGnuplot(png, kTerminal, script.str());
}

/// Pressure (kPa) and depth (m).
Curve pressureOverDepth(const RunRecord& record) {
  Curve curve;
  for (const PressureLayer& layer : record.pressure) curve.emplace_back(1e-3 * layer.pressure, layer.depth);
  return curve;
}

/// Time (s) and what the energy over the mass is above what was given (J/kg).
Curve energyOverTime(const RunRecord& record) {
  Curve curve;
  for (const EnergySample& sample : record.energy)
    curve.emplace_back(sample.time, sample.kinetic + sample.potential - sample.source);
  return curve;
}

/// rho0 g (kPa/m) of the study's first run; all share it unless gravity or the rest density vary.
double pressurePerDepth(const StudyPlan& plan) {
  const Scene scene = readScene(plan.scene, plan.overrides(1));
  return 1e-3 * scene.solver.restDensity * scene.gravity.norm();
}

bool varies(const StudyPlan& plan, const char* pointer) {
  return std::any_of(plan.axes.begin(), plan.axes.end(),
                     [&](const StudyAxis& axis) { return axis.pointer.find(pointer) != std::string::npos; });
}

}  // namespace

void plotProfiles(const std::filesystem::path& folder, const StudyPlan& plan,
                  const std::vector<FinishedRun>& runs) {
  double deepest = 0, longest = 0;
  for (const FinishedRun& run : runs) {
    for (const PressureLayer& layer : run.record.pressure) deepest = std::max(deepest, layer.depth);
    for (const EnergySample& sample : run.record.energy) longest = std::max(longest, sample.time);
  }
  Curve atRest;
  if (deepest > 0 && !varies(plan, "gravity") && !varies(plan, "rest_density"))
    atRest = {{0, 0}, {pressurePerDepth(plan) * deepest, deepest}};
  draw(folder / "pressure_profile.png", plan, runs,
       {"Pressure over depth",
        "set xlabel 'mean pressure of a layer, in the last tenth of the run (kPa)'\n"
        "set ylabel 'depth below the level that the volume has (m)'\nset yrange [*:*] reverse\n",
        pressureOverDepth, atRest, "at rest: ρ₀gz"});
  draw(folder / "energy.png", plan, runs,
       {"Energy that the solver has added",
        "set xlabel 'time (s)'\nset ylabel 'energy less what walls, emitters, effects gave (J/kg)'\n",
        energyOverTime,
        {{0, 0}, {longest, 0}},
        "bound: nothing from nothing"});
}

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
    columns.reserve(measures.size());
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

namespace {

std::string digits(double value, const char* format = "%.3g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Largest over smallest time of a run's repetitions, less 1; of all runs the largest.
double largestSpread(const std::vector<FinishedRun>& runs) {
  double largest = 0;
  for (const FinishedRun& run : runs) {
    double least = run.record.timings.front().wallMsPerSecond, most = least;
    for (const RunTiming& timing : run.record.timings) {
      least = std::min(least, timing.wallMsPerSecond);
      most = std::max(most, timing.wallMsPerSecond);
    }
    if (least > 0) largest = std::max(largest, most / least - 1);
  }
  return largest;
}

void describeFront(std::ostream& out, const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                   const AccuracyMeasure& measure) {
  const std::vector<std::size_t> front = frontOf(runs, measure);
  out << "\n## " << measure.title << "\n\n";
  if (front.empty()) {
    out << "No run has this measure.\n";
    return;
  }
  const std::string unit = measure.unit.empty() ? "" : " " + measure.unit;
  const auto error = [&](std::size_t at) { return *measure.error(runs[at].record); };
  const auto cost = [&](std::size_t at) { return runCost(runs[at].record); };
  const std::size_t cheapest = front.front(), best = front.back();
  out << "The most exact is run " << runs[best].run << " (" << plan.describe(runs[best].values)
      << "): " << digits(error(best)) << unit << " for " << digits(cost(best), "%.0f")
      << " ms a simulated second.";
  if (best != cheapest && cost(cheapest) > 0) {
    out << " The cheapest is run " << runs[cheapest].run << " (" << plan.describe(runs[cheapest].values)
        << "): " << digits(cost(cheapest), "%.0f") << " ms; the best accuracy costs "
        << digits(cost(best) / cost(cheapest), "%.2f") << " times as much";
    if (error(best) > 0) out << " and is " << digits(error(cheapest) / error(best)) << " times as exact";
    out << ".";
  } else {
    out << " No run is cheaper.";
  }
  out << "\n\n| on the front | ms a simulated second | ms once | " << tableCell(measure.title)
      << " |\n|---|---|---|---|\n";
  for (const std::size_t at : front)
    out << "| run " << runs[at].run << ": " << plan.describe(runs[at].values) << " | "
        << digits(cost(at), "%.0f") << " | "
        << digits(runs[at].record.measure("precomputation_ms").value_or(0), "%.0f") << " | "
        << digits(error(at)) << unit << " |\n";
}

}  // namespace

std::string tableCell(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string studySummary(const StudyPlan& plan, const std::vector<FinishedRun>& runs) {
  std::ostringstream out;
  std::size_t fewest = runs.front().record.timings.size();
  for (const FinishedRun& run : runs) fewest = std::min(fewest, run.record.timings.size());
  out << "# What accuracy costs: " << plan.scene.stem().string() << "\n\n"
      << runs.size() << " runs of " << plan.scene.string() << " to " << plan.until << " s, varied:\n\n";
  for (const StudyAxis& axis : plan.axes) {
    out << "- `" << axis.pointer << "`:";
    for (std::size_t k = 0; k < axis.values.size(); ++k) out << (k > 0 ? ", " : " ") << axis.values[k];
    out << '\n';
  }
  out << "\nTimes are medians of " << fewest << (fewest == 1 ? " repetition" : " repetitions")
      << ", taken substep by substep. Whole repetitions of one run differ by up to "
      << digits(100 * largestSpread(runs), "%.0f")
      << " %; where that is much, the machine was busy, and runs of nearly the same time may change places "
         "on "
         "the front. Errors of gamma and of the density are judged by the same reference for all runs "
         "(directions, 16384). What is made once (fits, grids, filling) is not in these times; \"ms once\" "
         "has it, "
         "as if for the first time.\n";
  for (const FinishedRun& run : runs)
    if (!run.record.trouble.empty())
      out << "\nRun " << run.run << " (" << plan.describe(run.values)
          << ") failed and is on no front: " << run.record.trouble << "\n";
  for (const AccuracyMeasure& measure : accuracyMeasures()) describeFront(out, plan, runs, measure);
  return out.str();
}

}  // namespace migiwa
