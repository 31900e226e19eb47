#include "app/commands/study_profiles.h"

#include <algorithm>
#include <functional>
#include <sstream>

#include "app/commands/gnuplot.h"
#include "app/commands/study_drawing.h"

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

/// The last sound run of each value of the first axis that has a curve.
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

}  // namespace migiwa
