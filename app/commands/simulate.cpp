// `migiwa simulate SCENE`: runs without any picture.
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "app/commands/progress_bar.h"
#include "app/commands/report_table.h"
#include "core/base/error.h"
#include "core/io/output_file.h"
#include "core/io/report.h"
#include "core/simulation/run.h"

namespace migiwa {

namespace {

constexpr double kLongestRun = 1e6;  // (s), as long as a scene's duration can be

struct SimulateOptions {
  std::string scene;
  std::optional<double> until;  ///< (s)
  std::string report;
};

/// The scene, after everything that the user gave has been looked at.
Scene checkedScene(const SimulateOptions& options, const CommonOptions& common) {
  std::vector<Fault> faults;
  const auto collect = [&](const auto& body) {
    try {
      body();
    } catch (const InputError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  };
  std::optional<Scene> scene;
  collect([&] { scene = readScene(options.scene, common.overrides); });
  const Range untilRange = Range::closed(0, kLongestRun);
  if (options.until && !untilRange.contains(*options.until)) {
    std::ostringstream message;
    message << "expected a number " << untilRange.text() << " (unit: s), found " << *options.until;
    faults.push_back({"--until", message.str()});
  }
  if (!options.report.empty()) collect([&] { requireWritable(options.report, "--report"); });
  if (!faults.empty()) throw InputError(std::move(faults));
  return *std::move(scene);
}

int simulate(const SimulateOptions& options, const CommonOptions& common) {
  const Scene scene = checkedScene(options, common);
  const double until = options.until.value_or(scene.duration);
  Simulation simulation(scene, common.threads);
  for (const std::string& warning : simulation.scene().warnings)
    std::cerr << options.scene << ": warning: " << warning << '\n';

  SettledMeasures settled;
  {
    ProgressBar progress(until, common.quiet);
    settled = runUntil(simulation, until, [&] {
      progress.update(simulation.time());
      return true;
    });
  }

  const Report report = makeReport(simulation, settled, common.overrides);
  if (options.report.empty()) {
    std::cout << reportTable({report});
  } else {
    writeTextFile(options.report, reportText(report));
  }
  if (!simulation.statistics().failed()) return kDone;
  for (const Trouble& trouble : report.trouble)
    std::cerr << options.scene << ": " << trouble.kind << " at step " << trouble.step << ": "
              << trouble.detail << '\n';
  return kNumericalTrouble;
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
        return [options](const CommonOptions& common) { return simulate(*options, common); };
      }};
}

}  // namespace migiwa
