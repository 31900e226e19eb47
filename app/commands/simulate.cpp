// `migiwa simulate SCENE`: runs without any picture.
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "app/commands/progress_bar.h"
#include "app/commands/report_table.h"
#include "app/commands/simulate_job.h"
#include "core/base/error.h"
#include "core/io/export_schedule.h"
#include "core/io/output_file.h"
#include "core/io/particle_export.h"
#include "core/io/report.h"
#include "core/io/save_file.h"
#include "core/simulation/run.h"

namespace migiwa {

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
      settled = runUntil(simulation_, until_, sampler_, [&] {
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
    if (export_ && (exportTimes_->due(frame) || frame == last_)) addToExport();
    if (options_.saveEvery && frame < last_ &&
        ExportSchedule(*options_.saveEvery, job_.scene.solver.timeStep).due(frame)) {
      // Whoever goes on from this save does not write again what came before it.
      if (export_) export_->flush();
      save();
    }
  }

  void addToExport() { export_->add(copyParticles(simulation_.view(), simulation_.frame(), job_.fields)); }

  void finishExport() {
    if (!export_) return;
    export_->finish();
    if (const long later = export_->laterFiles(); later > 0)
      std::cerr << options_.exportFolder
                << ": warning: files of an earlier, longer export follow those of this one (" << later
                << ")\n";
  }

  void save() { writeSave(options_.save, simulation_, sampler_, common_.overrides); }

  int report(const SettledMeasures& settled) const {
    const Report report = makeReport(simulation_, settled, common_.overrides);
    if (options_.report.empty()) {
      std::cout << reportTable({report});
    } else {
      writeTextFile(options_.report, reportText(report));
    }
    if (!simulation_.stopped()) return kDone;
    for (const Trouble& trouble : report.trouble)
      std::cerr << options_.scene << ": " << trouble.kind << " at step " << trouble.step << ": "
                << trouble.detail << '\n';
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
};

void addExportOptions(CLI::App& parser, SimulateOptions& options) {
  parser
      .add_option("--export", options.exportFolder,
                  "Folder for files of the particles, NAME_000000.ply and so on, and their list "
                  "NAME.ply.json.")
      ->type_name("DIR")
      ->group("Export");
  parser
      .add_option("--every", options.every,
                  "Simulated time from one exported file to the next, in s; start and end are exported, too.")
      ->type_name("S")
      ->group("Export");
  parser
      .add_option("--format", options.format,
                  "ply, vtk (with NAME.vtk.series for ParaView) or obj (positions only); left out: ply.")
      ->type_name("ply|vtk|obj")
      ->group("Export");
  std::string names;
  for (const ParticleFieldInfo& info : particleFields())
    names += (names.empty() ? "" : ", ") + std::string(info.name);
  parser
      .add_option("--fields", options.fields,
                  "What is exported with each position, with commas between: " + names +
                      "; left out: velocity,density,id.")
      ->type_name("A,B,...")
      ->group("Export");
}

void addSaveOptions(CLI::App& parser, SimulateOptions& options) {
  parser.add_option("--save", options.save, "Saves the state at the end there, to go on with --resume.")
      ->type_name("FILE")
      ->group("Save and resume");
  parser
      .add_option("--save-every", options.saveEvery,
                  "Saves on the way, too: simulated time from one save to the next, in s.")
      ->type_name("S")
      ->group("Save and resume");
  parser.add_option("--resume", options.resume, "Goes on from a save of the same scene and settings.")
      ->type_name("FILE")
      ->group("Save and resume");
}

}  // namespace

Command simulateCommand() {
  return {
      "simulate", "Runs a scene without pictures and reports what happened.", [](CLI::App& parser) {
        const auto options = std::make_shared<SimulateOptions>();
        parser.add_option("scene", options->scene, "Scene file.")->required()->type_name("SCENE");
        parser
            .add_option("--until", options->until, "Simulated time at the end, in s; left out: the scene's.")
            ->type_name("S");
        parser
            .add_option("--report", options->report, "Writes a report there; left out: prints a short one.")
            ->type_name("FILE");
        addExportOptions(parser, *options);
        addSaveOptions(parser, *options);
        return [options](const CommonOptions& common) { return SimulateRun(*options, common).run(); };
      }};
}

}  // namespace migiwa
