// What `migiwa study` was asked for, looked at and understood before anything is simulated or written.
#include "core/study/study.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "app/commands/plots.h"
#include "core/base/fields.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/base/parallel.h"
#include "core/scene/scene.h"
#include "core/simulation/simulation.h"

namespace migiwa {

struct StudyOptions {
  std::string scene, out;
  std::vector<std::string> vary, merge;
  std::optional<double> until;  ///< (s)
  int repeat = 3;
  bool list = false;
  std::optional<long> run;
};

struct StudyJob {
  StudyPlan plan;
  std::filesystem::path folder;
};

/// Throws InputError with every fault found.
StudyJob checkedStudyJob(const StudyOptions& options, const CommonOptions& common);

// `migiwa study SCENE --vary /pointer=a,b,c --out DIR`: what accuracy costs in time.

namespace {

class Study {
 public:
  Study(const StudyOptions& options, const CommonOptions& common)
      : options_(options), common_(common), job_(checkedStudyJob(options, common)) {}

  int run() {
    if (options_.list) return list();
    records_.resize(job_.plan.size());
    load(job_.folder);
    makeFolder(job_.folder / "runs", "--out");
    if (options_.merge.empty()) {
      simulate();
      // One of many: the others may be at work elsewhere, on the same folder.
      if (options_.run)
        return records_[static_cast<std::size_t>(*options_.run) - 1]->trouble.empty() ? kDone
                                                                                      : kNumericalTrouble;
    } else {
      merge();
    }
    return finish();
  }

 private:
  int list() const {
    for (std::size_t run = 1; run <= job_.plan.size(); ++run) {
      std::cout << run;
      const std::vector<std::string> values = job_.plan.values(run);
      for (std::size_t k = 0; k < values.size(); ++k)
        std::cout << '\t' << job_.plan.axes[k].pointer << '=' << values[k];
      std::cout << '\n';
    }
    return kDone;
  }

  /// Takes what is in a study's folder; all that does not belong to this study is a fault.
  void load(const std::filesystem::path& folder) {
    std::vector<Fault> faults;
    const int threads = ThreadPool(common_.threads).threads();
    for (std::size_t run = 1; run <= job_.plan.size(); ++run) {
      try {
        const std::filesystem::path file = recordFile(folder, run);
        std::optional<RunRecord> record = readRecord(file);
        if (!record) continue;
        if (record->fingerprint != runFingerprint(job_.plan, run))
          throw InputError(file.string(), "expected run " + std::to_string(run) +
                                              " of this study, found one of another: the scene, --set, "
                                              "--vary or --until differ; take another --out");
        if (options_.merge.empty() && record->threads != threads && pending(*record))
          throw InputError(file.string(), "expected times with " + std::to_string(threads) +
                                              " threads, found " + std::to_string(record->threads) +
                                              "; go on with --threads " + std::to_string(record->threads) +
                                              ", or take another --out");
        std::optional<RunRecord>& known = records_[run - 1];
        if (!known || known->timings.size() < record->timings.size()) known = std::move(record);
      } catch (const InputError& error) {
        faults.insert(faults.end(), error.faults().begin(), error.faults().end());
      }
    }
    // Of a larger study, or of one with other values.
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "runs", none)) {
      const std::string name = entry.path().stem().string();
      if (entry.path().extension() != ".json" || name.empty() ||
          name.find_first_not_of("0123456789") != std::string::npos || name.size() > 6)
        continue;
      if (std::stoul(name) > job_.plan.size())
        faults.push_back({entry.path().string(), "expected runs 1 to " + std::to_string(job_.plan.size()) +
                                                     " of this study, found one of another; take another "
                                                     "--out"});
    }
    if (!faults.empty()) throw InputError(std::move(faults));
  }

  bool pending(const RunRecord& record) const {
    return record.trouble.empty() && record.timings.size() < static_cast<std::size_t>(options_.repeat);
  }

  /// Round by round, each beginning with another run, so that whatever else the machine does in some minutes
  /// falls on all runs alike.
  void simulate() {
    const std::size_t size = job_.plan.size();
    const auto chosen = [&](std::size_t run) {
      return !options_.run || *options_.run == static_cast<long>(run);
    };
    const double until = job_.plan.until;
    double done = 0, all = 0;
    for (std::size_t run = 1; run <= size; ++run) {
      if (!chosen(run)) continue;
      all += until * options_.repeat;
      const std::optional<RunRecord>& record = records_[run - 1];
      if (record && !pending(*record)) done += until * options_.repeat;
      if (record && pending(*record)) done += until * static_cast<double>(record->timings.size());
    }
    ProgressBar progress(done, all, common_.quiet);
    for (int round = 0; round < options_.repeat; ++round) {
      for (std::size_t k = 0; k < size; ++k) {
        const std::size_t run =
            1 +
            (k + static_cast<std::size_t>(round) * size / static_cast<std::size_t>(options_.repeat)) % size;
        std::optional<RunRecord>& record = records_[run - 1];
        if (!chosen(run) ||
            (record && (!pending(*record) || record->timings.size() > static_cast<std::size_t>(round))))
          continue;
        TroubleNotes trouble(job_.plan.scene.string() + ", run " + std::to_string(run));
        const auto eachFrame = [&](const Simulation& simulation) {
          // Repetitions have the trouble of the first.
          if (!record) trouble.look(simulation.statistics(), progress);
          progress.update(done + simulation.time());
        };
        if (record) {
          repeatRun(job_.plan, run, common_.threads, eachFrame, *record);
        } else {
          record = firstRepetition(job_.plan, run, common_.threads, eachFrame);
        }
        done += until;
        writeRecord(recordFile(job_.folder, run), *record);
      }
    }
  }

  void merge() {
    for (const std::string& part : options_.merge) {
      std::error_code ignored;
      if (!std::filesystem::is_directory(std::filesystem::path(part) / "runs", ignored))
        throw InputError("--merge", "expected the --out of a study, found no folder " + part + "/runs");
      load(part);
    }
    std::string missing;
    for (std::size_t run = 1; run <= records_.size(); ++run)
      if (!records_[run - 1]) missing += (missing.empty() ? "" : ", ") + std::to_string(run);
    if (!missing.empty())
      throw InputError("--merge", "expected all " + std::to_string(records_.size()) +
                                      " runs, found none of " + missing + "; make them with --run");
    for (std::size_t run = 1; run <= records_.size(); ++run)
      writeRecord(recordFile(job_.folder, run), *records_[run - 1]);
  }

  int finish() const {
    std::vector<FinishedRun> runs;
    for (std::size_t run = 1; run <= records_.size(); ++run)
      runs.push_back({run, job_.plan.values(run), *records_[run - 1]});
    writeTextFile(job_.folder / "study.csv", studyCsv(job_.plan, runs));
    const std::string summary = studySummary(job_.plan, runs) + convergenceSummary(job_.plan, runs);
    writeTextFile(job_.folder / "summary.md", summary);
    const std::vector<AccuracyMeasure>& measures = accuracyMeasures();
    plotStudy(job_.folder / "cost_accuracy.png", job_.plan, runs, measures.front());
    for (std::size_t k = 1; k < measures.size(); ++k)
      plotStudy(job_.folder / (measures[k].column + ".png"), job_.plan, runs, measures[k]);
    plotConvergence(job_.folder, job_.plan, runs);
    plotProfiles(job_.folder, job_.plan, runs);
    std::cout << summary << "\nWritten to " << job_.folder.string()
              << ": study.csv, summary.md, cost_accuracy.png and a picture for each measure\n";
    int code = kDone;
    for (const FinishedRun& run : runs) {
      if (run.record.trouble.empty()) continue;
      std::cerr << recordFile(job_.folder, run.run).string() << ": " << run.record.trouble << '\n';
      code = kNumericalTrouble;
    }
    return code;
  }

  const StudyOptions& options_;
  const CommonOptions& common_;
  const StudyJob job_;
  std::vector<std::optional<RunRecord>> records_;  ///< of run k + 1
};

}  // namespace

Command studyCommand() {
  return {
      "study", "Shows what accuracy costs in time: a grid of runs, measured.", [] {
        const auto options = std::make_shared<StudyOptions>();
        return Declaration{
            {{.name = "scene",
              .target = &options->scene,
              .value = "SCENE",
              .help = "Scene file.",
              .required = true},
             {.name = "--vary",
              .target = &options->vary,
              .value = "/POINTER=A,B,...",
              .help =
                  "Values of a key of the scene, with commas between; repeatable: all combinations are run.",
              .required = true,
              .oneValueEach = true},
             {.name = "--until",
              .target = &options->until,
              .value = "S",
              .help = "Simulated time at the end of each run, in s; left out: the scene's."},
             {.name = "--out",
              .target = &options->out,
              .value = "DIR",
              .help = "Folder for study.csv, summary.md, the pictures and runs/K.json. What is there of this "
                      "study "
                      "already is not run again.",
              .required = true},
             {.name = "--repeat",
              .target = &options->repeat,
              .value = "N",
              .help = "How often each run is timed; left out: 3."},
             {.name = "--list",
              .target = &options->list,
              .help = "Prints the runs with their numbers, runs none."},
             {.name = "--run",
              .target = &options->run,
              .value = "K",
              .help = "Does one run and writes its runs/K.json, no table.",
              .excludes = {"--list"}},
             {.name = "--merge",
              .target = &options->merge,
              .value = "DIR...",
              .help = "Joins the runs in these folders, simulates nothing.",
              .excludes = {"--list", "--run"}}},
            [options](const CommonOptions& common) { return Study(*options, common).run(); }};
      }};
}

namespace {

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
