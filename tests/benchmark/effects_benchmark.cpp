// What each effect costs on the dam break: its own time and its part of the step, medians over the frames of
// the first second. The runs take turns frame by frame, so that what else the machine does falls on all.
//
// usage: effects_benchmark [threads]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/simulation/simulation.h"
#include "tests/support/test_effects.h"

namespace migiwa::benchmarks {
namespace {

struct Run {
  std::string label;
  std::string effect;  ///< whose time is taken; empty: none's
  std::unique_ptr<Simulation> simulation;
  std::vector<double> stepMs, effectMs;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void measure(int threads) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "{}"},
      {"viscosity", R"({"viscosity": {"xsph": 0.05}})"},
      {"viscosity", R"({"viscosity": {"xsph": 0, "kinematic": 1e-6}})"},
      {"viscosity", R"({"viscosity": {"xsph": 0, "kinematic": 0.01}})"},
      {"viscosity", R"({"viscosity": {"xsph": 0, "kinematic": 1}})"},
      {"vorticity_confinement", R"({"vorticity_confinement": {}})"},
      {"surface_tension", R"({"surface_tension": {}})"},
      {"artificial_pressure", R"({"artificial_pressure": {}})"},
      {"wall_friction", R"({"wall_friction": {}})"},
  };
  std::vector<Run> runs;
  for (const auto& [effect, json] : cases) {
    Scene scene = readScene(MIGIWA_SOURCE_DIR "/scenes/dam_break.json");
    scene.effects = testing::effectsOf(json);
    runs.push_back({json, effect, std::make_unique<Simulation>(scene, threads), {}, {}});
  }
  while (runs.front().simulation->time() < 1) {
    for (Run& run : runs) {
      run.simulation->advanceFrame();
      const FrameInfo& info = run.simulation->view().info;
      run.stepMs.push_back(1e3 * info.stepSeconds);
      if (!run.effect.empty()) run.effectMs.push_back(1e3 * info.stages.seconds(run.effect));
    }
  }
  std::printf("%-62s %10s %10s %8s\n", "effects of the dam break", "step ms", "effect ms", "percent");
  for (const Run& run : runs) {
    const double step = median(run.stepMs), effect = run.effect.empty() ? 0 : median(run.effectMs);
    std::printf("%-62s %10.3f %10.3f %8.1f\n", run.label.c_str(), step, effect, 100 * effect / step);
  }
}

}  // namespace
}  // namespace migiwa::benchmarks

int main(int argc, char** argv) {
  migiwa::benchmarks::measure(argc > 1 ? std::atoi(argv[1]) : 0);
  return 0;
}
