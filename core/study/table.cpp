#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>

#include "core/study/study.h"

namespace migiwa {

namespace {

/// Median of what `value` is for each repetition; the mean of the middle two of an even number.
double median(const RunRecord& record, const std::function<double(const RunTiming&)>& value) {
  std::vector<double> values;
  for (const RunTiming& timing : record.timings) values.push_back(value(timing));
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double share(const RunTiming& timing, const std::string& stage) {
  double sum = 0, own = 0;
  for (const StageTime& time : timing.stages) {
    sum += time.seconds;
    if (time.name == stage) own = time.seconds;
  }
  return sum > 0 ? own / sum : 0;
}

/// Shortest digits that read back to the same number.
std::string digits(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string cell(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? digits(*value) : "";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::vector<std::string> stageNames(const std::vector<FinishedRun>& runs) {
  std::vector<std::string> names;
  for (const FinishedRun& run : runs)
    for (const RunTiming& timing : run.record.timings)
      for (const StageTime& stage : timing.stages)
        if (std::find(names.begin(), names.end(), stage.name) == names.end()) names.push_back(stage.name);
  return names;
}

/// Of every gauge that a run has, in the order of the scene.
std::vector<std::string> gaugeColumns(const std::vector<FinishedRun>& runs) {
  std::vector<std::string> names;
  for (const FinishedRun& run : runs)
    for (const auto& [name, value] : run.record.measures)
      if (name.starts_with("gauge_") && std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  return names;
}

using Cells = std::function<std::string(const FinishedRun&)>;
struct Column {
  std::string name;
  Cells cells;
};

Column measured(const std::string& name) {
  return {name, [name](const FinishedRun& run) { return cell(run.record.measure(name)); }};
}

std::vector<Column> columns(const StudyPlan& plan, const std::vector<FinishedRun>& runs) {
  std::vector<Column> all;
  const auto add = [&](const std::string& name, const Cells& cells) { all.push_back({name, cells}); };
  add("run", [](const FinishedRun& run) { return std::to_string(run.run); });
  for (std::size_t k = 0; k < plan.axes.size(); ++k)
    add(plan.axes[k].pointer, [k](const FinishedRun& run) { return run.values[k]; });
  add("wall_ms_per_s", [](const FinishedRun& run) { return digits(runCost(run.record)); });
  add("ms_per_step", [](const FinishedRun& run) {
    return digits(median(run.record, [](const RunTiming& timing) { return timing.msPerStep; }));
  });
  for (const char* name : {"iterations",
                           "gamma_error",
                           "density_error_mean",
                           "density_error_max",
                           "height_error",
                           "edge_crowding",
                           "near_wall_spacing_p1",
                           "rms_speed",
                           "lost",
                           "memory_bytes",
                           "gamma_error_max",
                           "solver_density_error_mean",
                           "bulk_spacing_p1",
                           "particles",
                           "steps",
                           "nonfinite",
                           "gamma_gradient_error",
                           "pressure_error",
                           "energy_gained",
                           "energy_stored",
                           "wall_error",
                           "precomputation_ms",
                           "wave_kept",
                           "wave_period"})
    all.push_back(measured(name));
  for (const std::string& name : gaugeColumns(runs)) all.push_back(measured(name));
  const auto extreme = [](bool largest) {
    return [largest](const FinishedRun& run) {
      double found = run.record.timings.empty() ? 0 : run.record.timings.front().wallMsPerSecond;
      for (const RunTiming& timing : run.record.timings)
        found = largest ? std::max(found, timing.wallMsPerSecond) : std::min(found, timing.wallMsPerSecond);
      return digits(found);
    };
  };
  add("wall_ms_per_s_min", extreme(false));
  add("wall_ms_per_s_max", extreme(true));
  add("repeats", [](const FinishedRun& run) { return std::to_string(run.record.timings.size()); });
  add("threads", [](const FinishedRun& run) { return std::to_string(run.record.threads); });
  add("gamma_method", [](const FinishedRun& run) { return run.record.gammaMethod; });
  add("state_hash", [](const FinishedRun& run) { return run.record.stateHash; });
  std::vector<std::size_t> onFront;
  for (const std::size_t at : frontOf(runs, accuracyMeasures().front())) onFront.push_back(runs[at].run);
  add("on_front", [onFront](const FinishedRun& run) {
    return std::find(onFront.begin(), onFront.end(), run.run) != onFront.end() ? "1" : "0";
  });
  for (const std::string& stage : stageNames(runs))
    add("share_" + stage, [stage](const FinishedRun& run) {
      return digits(median(run.record, [&](const RunTiming& timing) { return share(timing, stage); }));
    });
  return all;
}

std::optional<double> valid(const RunRecord& record, const char* column) {
  return record.trouble.empty() ? record.measure(column) : std::nullopt;
}

}  // namespace

bool isTimeColumn(std::string_view column) {
  return column.starts_with("wall_ms_per_s") || column.starts_with("share_") || column == "ms_per_step" ||
         column == "memory_bytes" || column == "repeats" || column == "threads" || column == "on_front" ||
         column == "precomputation_ms";
}

const std::vector<AccuracyMeasure>& accuracyMeasures() {
  using Value = std::optional<double>;
  static const std::vector<AccuracyMeasure> measures{
      {"density_error_mean", "density error, mean", "",
       [](const RunRecord& r) { return valid(r, "density_error_mean"); }},
      {"density_error_max", "density error, largest", "",
       [](const RunRecord& r) { return valid(r, "density_error_max"); }},
      {"gamma_error", "error of γ near walls, mean", "",
       [](const RunRecord& r) { return valid(r, "gamma_error"); }},
      {"gamma_gradient_error", "error of h∇γ near walls, mean", "",
       [](const RunRecord& r) { return valid(r, "gamma_gradient_error"); }},
      {"height_error", "|settled height / expected − 1|", "",
       [](const RunRecord& r) {
         const Value found = valid(r, "height_error");
         return found ? Value(std::abs(*found)) : std::nullopt;
       }},
      {"edge_crowding", "|edge crowding − 1|", "",
       [](const RunRecord& r) {
         const Value found = valid(r, "edge_crowding");
         return found ? Value(std::abs(*found - 1)) : std::nullopt;
       }},
      {"near_wall_spacing_p1", "1 − spacing near walls, 1st percentile", "",
       [](const RunRecord& r) {
         const Value found = valid(r, "near_wall_spacing_p1");
         return found ? Value(std::max(1 - *found, 0.0)) : std::nullopt;
       }},
      {"pressure_error", "pressure off ρgz, rms over ρgH", "",
       [](const RunRecord& r) { return valid(r, "pressure_error"); }},
      {"rms_speed", "speed at the end, rms", "m/s", [](const RunRecord& r) { return valid(r, "rms_speed"); }},
      {"energy_gained", "energy that the solver has added, largest", "J/kg",
       [](const RunRecord& r) { return valid(r, "energy_gained"); }},
      {"wall_error", "distance of the fitted wall from its shape, mean", "m",
       [](const RunRecord& r) { return valid(r, "wall_error"); }},
  };
  return measures;
}

double runCost(const RunRecord& record) {
  const std::vector<RunTiming>& timings = record.timings;
  const std::size_t steps = timings.empty() ? 0 : timings.front().stepMicroseconds.size();
  double medians = 0, first = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    medians += median(record, [k](const RunTiming& timing) { return timing.stepMicroseconds.at(k); });
    first += timings.front().stepMicroseconds[k];
  }
  return first > 0 ? timings.front().wallMsPerSecond * medians / first
                   : median(record, [](const RunTiming& timing) { return timing.wallMsPerSecond; });
}

std::vector<std::size_t> frontOf(const std::vector<FinishedRun>& runs, const AccuracyMeasure& measure) {
  std::vector<CostAndError> points;
  for (const FinishedRun& run : runs) points.push_back({runCost(run.record), measure.error(run.record)});
  return paretoFront(points);
}

std::string studyCsv(const StudyPlan& plan, const std::vector<FinishedRun>& runs) {
  const std::vector<Column> all = columns(plan, runs);
  std::string text;
  for (const Column& column : all) text += (text.empty() ? "" : ",") + quoted(column.name);
  text += '\n';
  for (const FinishedRun& run : runs) {
    for (std::size_t k = 0; k < all.size(); ++k) text += (k > 0 ? "," : "") + quoted(all[k].cells(run));
    text += '\n';
  }
  return text;
}

}  // namespace migiwa
