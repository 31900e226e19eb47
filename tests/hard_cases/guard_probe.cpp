// usage: guard_probe on|off case NAME | guard_probe on|off scene FILE SECONDS [POINTER=VALUE]...
//
// Runs one hard case, or a scene for a time, on one thread, with the guards (core/solver/parameters.h) or
// without, and prints what they are judged by. Without them hard cases have no CFL rule either. A program of
// its own, for without guards it may fall.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string_view>
#include <vector>

#include "core/scene/scene_file.h"
#include "tests/hard_cases/hard_case.h"

namespace migiwa::testing {
namespace {

bool runCase(std::string_view name, Guards guards) {
  for (const HardCase& hardCase : hardCases()) {
    if (hardCase.name != name) continue;
    Scene scene = sceneOf(hardCase);
    if (guards == Guards::off) scene.solver.cfl = 0;
    const Observed seen = observe(scene, hardCase.until, 1, guards);
    std::printf("%016llx\n%s\n", static_cast<unsigned long long>(seen.hash), outcome(hardCase, seen).c_str());
    return true;
  }
  return false;
}

void runScene(const char* file, double until, const std::vector<Override>& overrides, Guards guards) {
  Simulation simulation(readScene(file, overrides), 1, guards);
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
  if (argc < 4) return 2;
  const std::string_view with = argv[1], mode = argv[2];
  if (with != "on" && with != "off") return 2;
  const migiwa::Guards guards = with == "on" ? migiwa::Guards::on : migiwa::Guards::off;
  if (mode == "case" && argc == 4) return migiwa::testing::runCase(argv[3], guards) ? 0 : 2;
  if (mode != "scene" || argc < 5) return 2;
  std::vector<migiwa::Override> overrides;
  for (int k = 5; k < argc; ++k) overrides.push_back(migiwa::Override::parse(argv[k]));
  migiwa::testing::runScene(argv[3], std::atof(argv[4]), overrides, guards);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
