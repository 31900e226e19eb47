// Energy that is gone stays gone: what other water has lost long before pays for no gain.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "tests/hard_cases/energy_watch.h"

namespace migiwa::testing {
namespace energy_regained_test {

bool notes(const Simulation& simulation, const std::string& kind) {
  for (const Trouble& trouble : simulation.statistics().trouble)
    if (trouble.kind == kind) return true;
  return false;
}

TEST(EnergyRegained, ALateImpactGetsNothingOfWhatAnEarlierOneLost) {
  // A block is stopped by a wall; 80 ms later two others meet in the air as in scenes/hard/head_on.json.
  const Scene scene = parseScene(R"({ "format": 1, "particle_spacing": 0.05, "gravity": [0, 0, 0],
      "fluid": [
        { "shape": "box", "min": [-0.35, 0, 0], "max": [-0.05, 0.3, 0.3], "velocity": [20, 0, 0] },
        { "shape": "box", "min": [4.05, 0.02, 0.01], "max": [4.35, 0.32, 0.31], "velocity": [-20, 0, 0] },
        { "shape": "box", "min": [0, -2, 0], "max": [0.3, -1.7, 0.3], "velocity": [0, -20, 0] }],
      "boundary": { "surfaces": [{ "shape": "plane", "point": [0, -2.1, 0], "normal": [0, 1, 0] }] },
      "solver": { "time_step": 0.002, "min_iterations": 1, "max_iterations": 1, "tolerance": 0.1,
        "kernel": "wendland_c2", "acceleration": "none", "cfl": 0 },
      "effects": { "viscosity": { "xsph": 0 } } })",
                                 "late.json");
  Simulation simulation(scene, 1);
  EnergyWatch energy(simulation);
  while (simulation.time() < 0.15) {
    simulation.advanceFrame();
    energy.look();
  }
  ASSERT_TRUE(notes(simulation, "energy_held"));
  EXPECT_LE(energy.mostRegained(), 0.01 * 0.5 * 20 * 20);
}

/// An open square of 2.4 m in 12 x 12 cells, at height 0.
std::string squareSheet() {
  constexpr int kCells = 12;
  std::ostringstream obj;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j)
      obj << "v " << -1.2 + 2.4 * i / kCells << " 0 " << -1.2 + 2.4 * j / kCells << '\n';
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const int a = i * (kCells + 1) + j + 1, b = a + kCells + 1;
      obj << "f " << a << ' ' << a + 1 << ' ' << b + 1 << ' ' << b << '\n';
    }
  }
  return obj.str();
}

TEST(EnergyRegained, WaterOnAnOpenSheetIsNotThrownUpAgain) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "migiwa_open_sheet";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "sheet.obj") << squareSheet();
  std::ofstream(folder / "sheet.json") << R"({ "format": 1, "particle_spacing": 0.05,
      "fluid": [{ "shape": "box", "min": [-0.3, 0.1, -0.3], "max": [0.3, 0.8, 0.3] }],
      "boundary": { "surfaces": [{ "shape": "mesh", "file": "sheet.obj", "fluid": "outside" }] } })";
  Simulation simulation(readScene((folder / "sheet.json").string()), 2);
  EnergyWatch energy(simulation);
  while (simulation.time() < 2 && !simulation.stopped()) {
    simulation.advanceFrame();
    energy.look();
  }
  EXPECT_LE(energy.mostGained(), energy.bound());
  // A tenth of the 1.3 J/kg that it loses as it hits the sheet.
  EXPECT_LE(energy.mostRegained(), 0.13);
}

}  // namespace energy_regained_test
}  // namespace migiwa::testing
