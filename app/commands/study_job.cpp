#include "app/commands/study_job.h"

#include <algorithm>
#include <sstream>

#include "app/commands/fault_collector.h"
#include "app/commands/option_text.h"
#include "core/base/fields.h"
#include "core/io/output_file.h"
#include "core/scene/run_limit.h"
#include "core/simulation/settings.h"

namespace migiwa {

namespace {

constexpr double kLongestRun = 1e6;  // (s), as long as a scene's duration can be
constexpr std::size_t kMostRuns = 10000;
constexpr int kMostRepeats = 100;

/// One --vary; faults at the option.
StudyAxis readAxis(const std::string& text, FaultCollector& collect) {
  StudyAxis axis;
  collect([&] {
    for (const Override& variant : parseVariants(text, "--vary")) {
      axis.pointer = variant.pointer;
      if (variant.value.empty())
        throw InputError("--vary",
                         "expected values with commas between them, found an empty one in \"" + text + "\"");
      if (std::find(axis.values.begin(), axis.values.end(), variant.value) != axis.values.end())
        throw InputError("--vary",
                         "expected each value once, found " + variant.value + " again in \"" + text + "\"");
      const auto parts = [](const std::string& whole) { return std::count(whole.begin(), whole.end(), ':'); };
      if (axis.pointer.find(':') != std::string::npos && parts(variant.value) > parts(axis.pointer))
        throw InputError("--vary",
                         "expected at most as many parts as pointers, with colons between them, "
                         "found \"" +
                             variant.value + "\" for " + axis.pointer);
      axis.values.push_back(variant.value);
    }
  });
  return axis;
}

void requireFolder(const std::filesystem::path& folder) {
  std::filesystem::path there = std::filesystem::absolute(folder);
  std::error_code ignored;
  while (!std::filesystem::exists(there, ignored) && there.has_relative_path()) there = there.parent_path();
  if (!std::filesystem::is_directory(there, ignored))
    throw InputError("--out", "expected a folder, found the file " + there.string());
  requireWritable(there / "study.csv", "--out");
}

template <class Number>
void requireRange(FaultCollector& collect, const char* option, Number value, bool good,
                  const std::string& expected) {
  if (good) return;
  std::ostringstream message;
  message << "expected " << expected << ", found " << value;
  collect.add({option, message.str()});
}

}  // namespace

StudyJob checkedStudyJob(const StudyOptions& options, const CommonOptions& common) {
  FaultCollector collect;
  StudyJob job{{options.scene, common.overrides, {}, 0}, options.out};
  StudyPlan& plan = job.plan;
  for (const std::string& text : options.vary) {
    StudyAxis axis = readAxis(text, collect);
    const auto same = [&](const StudyAxis& known) { return known.pointer == axis.pointer; };
    if (axis.values.empty()) continue;
    if (std::any_of(plan.axes.begin(), plan.axes.end(), same)) {
      collect.add({"--vary", "expected each pointer once, found " + axis.pointer + " again"});
    } else {
      plan.axes.push_back(std::move(axis));
    }
  }
  if (options.until)
    requireRange(collect, "--until", *options.until, Range::positive(kLongestRun).contains(*options.until),
                 "a number " + Range::positive(kLongestRun).text() + " (unit: s)");
  requireRange(collect, "--repeat", options.repeat, options.repeat >= 1 && options.repeat <= kMostRepeats,
               "a whole number in [1, " + std::to_string(kMostRepeats) + "]");
  const std::size_t size = plan.size();
  requireRange(collect, "--vary", size, size <= kMostRuns,
               "at most " + std::to_string(kMostRuns) + " runs in all");
  if (options.run && size <= kMostRuns)
    requireRange(collect, "--run", *options.run, *options.run >= 1 && *options.run <= static_cast<long>(size),
                 "the number of a run in [1, " + std::to_string(size) + "] (--list shows them)");
  collect([&] { requireFolder(job.folder); });
  if (size <= kMostRuns) {
    std::optional<double> duration;
    for (std::size_t run = 1; run <= size; ++run)
      collect([&] {
        const Scene scene = readScene(plan.scene, plan.overrides(run));
        requireSteppable(scene.boundary, scene.file);
        if (!duration) duration = scene.duration;
        if (options.until || scene.duration != *duration)
          requireReachable(scene, options.until.value_or(*duration), options.until ? "--until" : "--vary");
      });
    plan.until = options.until.value_or(duration.value_or(0));
  }
  collect.raise();
  return job;
}

}  // namespace migiwa
