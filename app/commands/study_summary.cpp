#include "app/commands/study_summary.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace migiwa {

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
