// What `migiwa simulate` was asked for, looked at and understood before anything is simulated or written.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/io/particle_export.h"
#include "core/io/report.h"
#include "core/io/save_file.h"
#include "core/scene/scene.h"
#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"

namespace migiwa {

struct SimulateOptions {
  std::string scene;
  std::optional<double> until;  ///< (s)
  std::string report, gauges;
  std::string exportFolder, format, fields;
  std::optional<double> every;  ///< (s)
  std::string save, resume;
  std::optional<double> saveEvery;  ///< (s)
};

struct SimulateJob {
  Scene scene;
  ParticleFormat format;            ///< of the export, if there is one
  std::vector<std::string> fields;  ///< of the export
};

/// Throws InputError with every fault found.
SimulateJob checkedSimulateJob(const SimulateOptions& options, const CommonOptions& common);

// `migiwa simulate SCENE`: runs without any picture.

namespace {

/// A run with all that is written on the way.
class SimulateRun {
 public:
  SimulateRun(const SimulateOptions& options, const CommonOptions& common)
      : options_(options),
        common_(common),
        job_(checkedSimulateJob(options, common)),
        simulation_(job_.scene, common.threads),
        until_(options.until.value_or(job_.scene.duration)) {
    for (const std::string& warning : simulation_.scene().warnings)
      std::cerr << options_.scene << ": warning: " << warning << '\n';
    if (!options_.resume.empty()) resume();
    last_ = simulation_.frameAt(until_);
  }

  int run() {
    beginExport();
    SettledMeasures settled;
    {
      ProgressBar progress(simulation_.time(), until_, common_.quiet);
      trouble_.look(simulation_.statistics(), progress);
      settled = runUntil(simulation_, until_, sampler_, [&] {
        trouble_.look(simulation_.statistics(), progress);
        progress.update(simulation_.time());
        if (!simulation_.stopped()) afterFrame();
        return true;
      });
    }
    finishExport();
    if (!options_.save.empty() && simulation_.goodState()) save();
    return report(settled);
  }

 private:
  void resume() {
    readSave(options_.resume, simulation_, sampler_);
    trouble_.takeAsSaid(simulation_.statistics());
    if (simulation_.frameAt(until_) >= simulation_.frame()) return;
    std::ostringstream message;
    message << "expected at least " << simulation_.time() << " s, the time of " << options_.resume
            << ", found " << until_ << " s" << (options_.until ? "" : ", the duration of the scene");
    throw InputError("--until", message.str());
  }

  void beginExport() {
    if (options_.exportFolder.empty()) return;
    const long frame = simulation_.frame();
    const double timeStep = job_.scene.solver.timeStep;
    exportTimes_.emplace(*options_.every, timeStep);
    export_ =
        std::make_unique<ParticleExport>(ExportOptions{options_.exportFolder, job_.scene.stem(), job_.format,
                                                       job_.fields, options_.scene, overrideTexts()},
                                         exportTimes_->countBefore(frame));
    if (exportTimes_->due(frame) || frame == last_) addToExport();
  }

  void afterFrame() {
    const long frame = simulation_.frame();
    if (export_) {
      if (exportTimes_->due(frame) || frame == last_) {
        addToExport();
      } else {
        lastGood_ = particles();
      }
    }
    if (options_.saveEvery && frame < last_ &&
        ExportSchedule(*options_.saveEvery, job_.scene.solver.timeStep).due(frame)) {
      // Whoever goes on from this save does not write again what came before it.
      if (export_) export_->flush();
      save();
    }
  }

  ParticleFrame particles() const {
    return copyParticles(simulation_.view(), simulation_.frame(), job_.fields, job_.scene.origin);
  }

  void addToExport() {
    exported_ = simulation_.time();
    lastGood_.reset();
    export_->add(particles());
  }

  /// Of a run that has stopped: the state before the step that was refused, or that of the frame before what
  /// was lost.
  void exportLastGood() {
    if (simulation_.goodState() && simulation_.time() > exported_) lastGood_ = particles();
    const double time = lastGood_ ? lastGood_->time : exported_;
    if (lastGood_) export_->add(std::move(*lastGood_));
    std::cerr << options_.exportFolder << ": the last file has the last good frame, at " << time << " s\n";
  }

  void finishExport() {
    if (!export_) return;
    if (simulation_.stopped()) exportLastGood();
    export_->finish();
    if (const long later = export_->laterFiles(); later > 0)
      std::cerr << options_.exportFolder
                << ": warning: files of an earlier, longer export follow those of this one (" << later
                << ")\n";
  }

  void save() { writeSave(options_.save, simulation_, sampler_, common_.overrides); }

  int report(const SettledMeasures& settled) {
    const Report report = makeReport(simulation_, settled, common_.overrides);
    if (!options_.gauges.empty()) writeTextFile(options_.gauges, gaugesCsv(report));
    if (options_.report.empty()) {
      std::cout << reportTable({report});
    } else {
      writeTextFile(options_.report, reportText(report));
    }
    if (!simulation_.stopped()) return kDone;
    trouble_.finish(simulation_.statistics());
    return kNumericalTrouble;
  }

  std::vector<std::string> overrideTexts() const {
    std::vector<std::string> texts;
    for (const Override& override : common_.overrides)
      texts.push_back(override.pointer + "=" + override.value);
    return texts;
  }

  const SimulateOptions& options_;
  const CommonOptions& common_;
  const SimulateJob job_;
  Simulation simulation_;
  SettledSampler sampler_;
  double until_;   ///< (s)
  long last_ = 0;  ///< frame at the end
  std::optional<ExportSchedule> exportTimes_;
  std::unique_ptr<ParticleExport> export_;
  std::optional<ParticleFrame> lastGood_;  ///< of an export: the last frame, unless it was exported
  double exported_ = 0;                    ///< time of the last frame that was (s)
  TroubleNotes trouble_{options_.scene};
};

std::vector<Option> ownOptions(SimulateOptions& options) {
  std::string fields;
  for (const ParticleFieldInfo& info : particleFields())
    fields += (fields.empty() ? "" : ", ") + std::string(info.name);
  const std::string exports = "Export", saves = "Save and resume";
  return {
      {.name = "scene", .target = &options.scene, .value = "SCENE", .help = "Scene file.", .required = true},
      {.name = "--until",
       .target = &options.until,
       .value = "S",
       .help = "Simulated time at the end, in s; left out: the scene's."},
      {.name = "--report",
       .target = &options.report,
       .value = "FILE",
       .help = "Writes a report there; left out: prints a short one."},
      {.name = "--gauges",
       .target = &options.gauges,
       .value = "FILE",
       .help = "Writes what the gauges of the scene show over time there, as CSV."},
      {.name = "--export",
       .target = &options.exportFolder,
       .value = "DIR",
       .help = "Folder for files of the particles, NAME_000000.ply and so on, and their list NAME.ply.json.",
       .group = exports},
      {.name = "--every",
       .target = &options.every,
       .value = "S",
       .help = "Simulated time from one exported file to the next, in s; start and end are exported, too.",
       .group = exports},
      {.name = "--format",
       .target = &options.format,
       .value = "ply|vtk|obj",
       .help = "ply, vtk (with NAME.vtk.series for ParaView) or obj (positions only); left out: ply.",
       .group = exports},
      {.name = "--fields",
       .target = &options.fields,
       .value = "A,B,...",
       .help = "What is exported with each position, with commas between: " + fields +
               "; left out: velocity,density,id.",
       .group = exports},
      {.name = "--save",
       .target = &options.save,
       .value = "FILE",
       .help = "Saves the state at the end there, to go on with --resume.",
       .group = saves},
      {.name = "--save-every",
       .target = &options.saveEvery,
       .value = "S",
       .help = "Saves on the way, too: simulated time from one save to the next, in s.",
       .group = saves},
      {.name = "--resume",
       .target = &options.resume,
       .value = "FILE",
       .help = "Goes on from a save of the same scene and settings.",
       .group = saves}};
}

}  // namespace

Command simulateCommand() {
  return {"simulate", "Runs a scene without pictures and reports what happened.", [] {
            const auto options = std::make_shared<SimulateOptions>();
            return Declaration{ownOptions(*options), [options](const CommonOptions& common) {
                                 return SimulateRun(*options, common).run();
                               }};
          }};
}

namespace {

class JobReader {
 public:
  JobReader(const SimulateOptions& options, const CommonOptions& common)
      : options_(options), common_(common) {}

  SimulateJob read() {
    std::optional<Scene> scene;
    collect([&] {
      scene = readScene(options_.scene, common_.overrides);
      requireSteppable(scene->boundary, scene->file);
    });
    seconds("--until", options_.until, Range::closed(0, kLongestRun));
    if (scene && options_.until && Range::closed(0, kLongestRun).contains(*options_.until))
      collect([&] { requireReachable(*scene, *options_.until, "--until"); });
    writable("--report", options_.report);
    writable("--gauges", options_.gauges);
    needs("--gauges", !options_.gauges.empty(), "gauges in the scene", !scene || !scene->gauges.empty());
    readExport(scene ? scene->stem() : "");
    seconds("--save-every", options_.saveEvery, Range::positive(kLongestRun));
    needs("--save-every", options_.saveEvery.has_value(), "--save FILE", !options_.save.empty());
    writable("--save", options_.save);
    if (!faults_.empty()) throw InputError(std::move(faults_));
    return {*std::move(scene), *format_, fields_};
  }

 private:
  template <class Body>
  void collect(const Body& body) {
    try {
      body();
    } catch (const InputError& error) {
      faults_.insert(faults_.end(), error.faults().begin(), error.faults().end());
    }
  }

  void seconds(const char* option, const std::optional<double>& value, const Range& range) {
    collect([&] { requireNumber(option, value, range, "s"); });
  }

  void needs(const char* option, bool given, const std::string& other, bool otherGiven) {
    if (given && !otherGiven) faults_.push_back({option, "expected " + other + " with it, found none"});
  }

  void writable(const char* option, const std::string& file) {
    if (!file.empty()) collect([&] { requireWritable(file, option); });
  }

  void readExport(const std::string& stem) {
    const std::string& folder = options_.exportFolder;
    readFormat();
    readFields();
    seconds("--every", options_.every, Range::positive(kLongestRun));
    needs("--every", options_.every.has_value(), "--export DIR", !folder.empty());
    needs("--format", !options_.format.empty(), "--export DIR", !folder.empty());
    needs("--fields", !options_.fields.empty(), "--export DIR", !folder.empty());
    if (folder.empty()) return;
    needs("--export", true, "--every S", options_.every.has_value());
    std::error_code ignored;
    if (std::filesystem::is_directory(folder, ignored) && format_) {
      writable("--export", (std::filesystem::path(folder) / exportListName(stem, *format_)).string());
    } else if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored)) {
      faults_.push_back({"--export", "expected a folder, found the file " + folder});
    }
  }

  void readFormat() {
    std::vector<std::string_view> names;
    for (const ParticleFormat& format : particleFormats()) {
      names.push_back(format.name);
      if (options_.format.empty() ? names.size() == 1 : format.name == options_.format) format_ = format;
    }
    if (!format_)
      faults_.push_back(
          {"--format", "expected one of " + quotedList(names) + ", found \"" + options_.format + "\""});
  }

  void readFields() {
    if (format_ && !format_->holdsFields) {
      if (!options_.fields.empty())
        faults_.push_back({"--fields", "expected none with --format " + std::string(format_->name) +
                                           ", which holds positions only; ply and vtk hold fields"});
      return;
    }
    if (options_.fields.empty()) {
      fields_ = {"velocity", "density", "id"};
      return;
    }
    std::vector<std::string_view> names;
    for (const ParticleFieldInfo& info : particleFields()) names.push_back(info.name);
    std::istringstream words(options_.fields + ",");
    for (std::string word; std::getline(words, word, ',');) {
      if (std::find(names.begin(), names.end(), word) == names.end()) {
        faults_.push_back({"--fields", "expected some of " + quotedList(names) + ", found \"" + word + "\""});
      } else if (std::find(fields_.begin(), fields_.end(), word) != fields_.end()) {
        faults_.push_back({"--fields", "expected each field once, found \"" + word + "\" again"});
      } else {
        fields_.push_back(word);
      }
    }
  }

  const SimulateOptions& options_;
  const CommonOptions& common_;
  std::vector<Fault> faults_;
  std::optional<ParticleFormat> format_;
  std::vector<std::string> fields_;
};

}  // namespace

SimulateJob checkedSimulateJob(const SimulateOptions& options, const CommonOptions& common) {
  return JobReader(options, common).read();
}

}  // namespace migiwa
