// `migiwa truth [NAME...] --out DIR`: runs cases whose answer is known, and compares.
#include "core/study/truth.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "app/commands/plots.h"
#include "core/base/files.h"
#include "core/base/messages.h"

namespace migiwa {

namespace {

struct TruthOptions {
  std::vector<std::string> names;
  std::string scenes, out;
  bool quick = false;
};

/// A case with what its runs have found.
struct JudgedSetting {
  std::string label;
  TruthFindings findings;
  double wallPerSecond = 0;  ///< (s)
  double particles = 0;
  std::string trouble;  ///< why the run has stopped; empty: it did not
};

std::string shown(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? formatNumber("%.4g", *value) : "none";
}

std::string shownError(const TruthAnswer& answer) {
  const auto error = answer.error();
  return error && std::isfinite(*error) ? formatNumber("%+.1f %%", 100 * *error) : "none";
}

/// The curves of one title, of all settings, beside what is known.
void draw(const std::filesystem::path& png, const std::vector<JudgedSetting>& runs, std::size_t curve) {
  std::ostringstream data, plot;
  const auto block = [&](const std::string& name, const Series& series) {
    data << name << " << EOD\n";
    for (std::size_t k = 0; k < series.times.size(); ++k)
      data << series.times[k] << ' ' << series.values[k] << '\n';
    data << "EOD\n";
  };
  const TruthCurve& first = runs.front().findings.curves[curve];
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Series& found = runs[k].findings.curves[curve].found;
    if (found.empty()) continue;
    const std::string name = "$run" + std::to_string(k);
    block(name, found);
    plot << name << " using 1:2 with lines linewidth 2 linecolor rgb '" << lineColor(k) << "' title "
         << quotedForGnuplot(runs[k].label) << ", ";
  }
  if (!first.known.empty()) {
    block("$known", first.known);
    plot << "$known using 1:2 with "
         << (first.points ? "points pointtype 7 pointsize 1.2" : "lines linewidth 2 dashtype 2")
         << " linecolor rgb 'black' title 'known'";
  }
  if (plot.str().empty()) return;
  std::ostringstream script;
  script << data.str() << "set title " << quotedForGnuplot(first.title)
         << " font 'DejaVu Sans,15'\nset grid linecolor rgb '#e0e0e0'\n"
            "set key outside right top Left reverse\nset xlabel "
         << quotedForGnuplot(first.across) << "\nset ylabel " << quotedForGnuplot(first.axis) << "\nplot "
         << plot.str() << '\n';
  drawWithGnuplot(png, "pngcairo noenhanced size 960,480 font 'DejaVu Sans,12'", script.str());
}

class Truth {
 public:
  Truth(const TruthOptions& options, const CommonOptions& common) : options_(options), common_(common) {
    FaultCollector collect;
    for (const std::string& name : options.names) collect([&] { cases_.push_back(&truthCase(name)); });
    collect([&] {
      scenes_ = options.scenes.empty() ? shippedPlace(std::filesystem::path("scenes") / "truth", "--scenes",
                                                      "a folder of scenes")
                                       : std::filesystem::path(options.scenes);
    });
    collect([&] { makeFolder(options.out, "--out"); });
    collect.raise();
    if (cases_.empty())
      for (const TruthCase& which : truthCases()) cases_.push_back(&which);
  }

  int run() {
    std::string table, csv = "case,setting,particles,quantity,known,found,error,wall_s_per_s\n";
    for (const TruthCase* which : cases_) {
      const std::vector<JudgedSetting> runs = judge(*which);
      table += tableOf(*which, runs);
      csv += rowsOf(*which, runs);
      const std::size_t curves = runs.front().findings.curves.size();
      for (std::size_t k = 0; k < curves; ++k) draw(pictureOf(*which, k), runs, k);
    }
    const std::filesystem::path out = options_.out;
    writeTextFile(out / "truth.csv", csv);
    writeTextFile(out / "truth.md", table);
    std::cout << table << "Written to " << options_.out << ": truth.md, truth.csv, pictures and reports\n";
    return stopped_ ? kNumericalTrouble : kDone;
  }

 private:
  std::filesystem::path pictureOf(const TruthCase& which, std::size_t curve) const {
    const std::string number = curve > 0 ? "_" + std::to_string(curve + 1) : "";
    return std::filesystem::path(options_.out) / (which.name + number + ".png");
  }

  std::vector<JudgedSetting> judge(const TruthCase& which) {
    std::vector<JudgedSetting> runs;
    for (const TruthSetting& setting : which.settings) {
      if (options_.quick && !runs.empty()) break;
      if (!common_.quiet) std::cerr << which.name << ", " << setting.label << '\n';
      std::unique_ptr<ProgressBar> progress;
      const TruthRun run = runTruth(
          which, scenes_, setting, common_.overrides, common_.threads, [&](const Simulation& simulation) {
            if (!progress)
              progress = std::make_unique<ProgressBar>(0, simulation.scene().duration, common_.quiet);
            progress->update(simulation.time());
          });
      progress.reset();
      const Report& report = run.report;
      const double simulated = report.simulatedSeconds.value_or(0);
      JudgedSetting& judged = runs.emplace_back();
      judged.label = setting.label;
      judged.findings = which.judge(run);
      judged.wallPerSecond = simulated > 0 ? report.wallSeconds.value_or(0) / simulated : 0;
      judged.particles = report.startedParticles.value_or(0);
      if (report.lostParticles.value_or(0) > 0 || report.nonfiniteParticles.value_or(0) > 0)
        judged.trouble = report.trouble.empty() ? "stopped" : report.trouble.back().kind;
      stopped_ = stopped_ || !judged.trouble.empty();
      const std::string file = which.name + "_" + std::to_string(runs.size()) + ".json";
      writeTextFile(std::filesystem::path(options_.out) / file, reportText(report));
    }
    return runs;
  }

  static std::string tableOf(const TruthCase& which, const std::vector<JudgedSetting>& runs) {
    std::string text = "### " + which.name + "\n\n" + which.known + ".\n\n";
    text += "| setting | particles | quantity | known | found | error | wall s a simulated s |\n";
    text += "|---|---|---|---|---|---|---|\n";
    for (const JudgedSetting& run : runs)
      for (const TruthAnswer& answer : run.findings.answers)
        text += "| " + tableCell(run.label) + (run.trouble.empty() ? "" : " (" + run.trouble + ")") + " | " +
                formatNumber("%.0f", run.particles) + " | " + tableCell(answer.quantity) + " | " +
                shown(answer.known) + " | " + shown(answer.found) + " | " + shownError(answer) + " | " +
                formatNumber("%.2g", run.wallPerSecond) + " |\n";
    return text + "\n";
  }

  static std::string rowsOf(const TruthCase& which, const std::vector<JudgedSetting>& runs) {
    std::string text;
    const auto cell = [](const std::optional<double>& value) {
      return value && std::isfinite(*value) ? formatNumber("%.9g", *value) : std::string();
    };
    for (const JudgedSetting& run : runs)
      for (const TruthAnswer& answer : run.findings.answers)
        text += which.name + ",\"" + run.label + "\"," + formatNumber("%.0f", run.particles) + ",\"" +
                answer.quantity + "\"," + cell(answer.known) + "," + cell(answer.found) + "," +
                cell(answer.error()) + "," + cell(run.wallPerSecond) + "\n";
    return text;
  }

  const TruthOptions& options_;
  const CommonOptions& common_;
  std::filesystem::path scenes_;
  std::vector<const TruthCase*> cases_;
  bool stopped_ = false;
};

}  // namespace

Command truthCommand() {
  return {"truth", "Runs cases whose answer is known, and says how far off the water is.", [] {
            const auto options = std::make_shared<TruthOptions>();
            std::string names;
            for (const TruthCase& which : truthCases()) names += (names.empty() ? "" : ", ") + which.name;
            return Declaration{
                {{.name = "names",
                  .target = &options->names,
                  .value = "NAME...",
                  .help = "Cases; left out: all. " + names + "."},
                 {.name = "--out",
                  .target = &options->out,
                  .value = "DIR",
                  .help = "Folder for truth.md, truth.csv, a picture for each curve, and the reports.",
                  .required = true},
                 {.name = "--scenes",
                  .target = &options->scenes,
                  .value = "DIR",
                  .help = "Folder of the cases' scenes; left out: scenes/truth, here or above the program."},
                 {.name = "--quick",
                  .target = &options->quick,
                  .help = "Each case with its first setting only."}},
                [options](const CommonOptions& common) { return Truth(*options, common).run(); }};
          }};
}

}  // namespace migiwa
