#include "core/study/truth.h"

#include <algorithm>
#include <utility>

#include "core/base/messages.h"
#include "core/simulation/measures.h"

namespace migiwa {

Series TruthRun::gauge(const std::string& name) const {
  for (const GaugeReport& gauge : report.gauges)
    if (gauge.name == name) return {gauge.times, gauge.values};
  return {};
}

std::optional<double> TruthAnswer::error() const {
  if (!found) return std::nullopt;
  return (*found - known) / (scale > 0 ? scale : known);
}

TruthSetting fromPositions(TruthSetting setting) {
  setting.label += ", from positions";
  for (const char* override : {"/solver/velocity_step=positions", "/effects/viscosity/xsph=0.05"})
    setting.overrides.emplace_back(override);
  return setting;
}

const std::vector<TruthCase>& truthCases() {
  static const std::vector<TruthCase> all = [] {
    std::vector<TruthCase> cases = truthWaves();
    for (TruthCase& flow : truthFlows()) cases.push_back(std::move(flow));
    // Surface tension goes with velocities from positions anyway, and XSPH hides what is viscous.
    for (TruthCase& one : cases) {
      if (one.name.find("drop") != std::string::npos || one.name == "viscous_vortex") continue;
      const std::vector<TruthSetting> settings = one.settings;
      for (const TruthSetting& setting : settings) one.settings.push_back(fromPositions(setting));
    }
    return cases;
  }();
  return all;
}

const TruthCase& truthCase(const std::string& name) {
  const std::vector<TruthCase>& all = truthCases();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const TruthCase& known) { return known.name == name; });
  if (found != all.end()) return *found;
  std::vector<std::string_view> names;
  for (const TruthCase& known : all) names.push_back(known.name);
  throw InputError("NAME", "expected one of " + quotedList(names) + ", found \"" + name + "\"");
}

TruthRun runTruth(const TruthCase& which, const std::filesystem::path& scenes, const TruthSetting& setting,
                  const std::vector<Override>& more, int threads,
                  const std::function<void(const Simulation&)>& eachFrame) {
  std::vector<Override> overrides;
  for (const std::string& text : setting.overrides) overrides.push_back(Override::parse(text));
  overrides.insert(overrides.end(), more.begin(), more.end());
  Simulation simulation(readScene(scenes / (which.name + ".json"), overrides), threads);
  const SettledMeasures settled = runUntil(simulation, simulation.scene().duration, [&] {
    if (eachFrame) eachFrame(simulation);
    return true;
  });
  return {simulation.scene(), makeReport(simulation, settled, overrides)};
}

}  // namespace migiwa
