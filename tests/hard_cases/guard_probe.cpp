// usage: guard_probe case NAME | guard_probe scene FILE SECONDS [POINTER=VALUE]...
//
// Runs one hard case, or a scene for a time, on one thread, and prints what core/base/guard.h is judged by.
// Built twice: with the program's guards, and without any. Hard cases then have no CFL rule either.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string_view>
#include <vector>

#include "core/base/guard.h"
#include "core/scene/scene_reader.h"
#include "tests/hard_cases/hard_case.h"

namespace migiwa::testing {
namespace {

bool runCase(std::string_view name) {
  for (const HardCase& hardCase : hardCases()) {
    if (hardCase.name != name) continue;
    Scene scene = sceneOf(hardCase);
    if (!kGuards) scene.solver.cfl = 0;
    const Observed seen = observe(scene, hardCase.until, 1);
    std::printf("%016llx\n%s\n", static_cast<unsigned long long>(seen.hash), outcome(hardCase, seen).c_str());
    return true;
  }
  return false;
}

void runScene(const char* file, double until, const std::vector<Override>& overrides) {
  Simulation simulation(readScene(file, overrides), 1);
  const long last = simulation.frameAt(until);
  // Of the processor rather than of the clock on the wall, which others slow down.
  const std::clock_t began = std::clock();
  while (simulation.frame() < last && !simulation.stopped()) simulation.advanceFrame();
  const double seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  const RunStatistics& run = simulation.statistics();
  std::printf("%016llx %ld %ld %.9g\n", static_cast<unsigned long long>(simulation.stateHash()),
              simulation.frame(), run.steps, seconds);
}

}  // namespace
}  // namespace migiwa::testing

int main(int argc, char** argv) try {
  const std::string_view mode = argc > 1 ? argv[1] : "";
  if (mode == "case" && argc == 3) return migiwa::testing::runCase(argv[2]) ? 0 : 2;
  if (mode != "scene" || argc < 4) return 2;
  std::vector<migiwa::Override> overrides;
  for (int k = 4; k < argc; ++k) overrides.push_back(migiwa::Override::parse(argv[k]));
  migiwa::testing::runScene(argv[2], std::atof(argv[3]), overrides);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
