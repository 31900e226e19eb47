// What walls that are not what they seem do to a run: fits that miss their shape a little, solids that
// overlap.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/support/mesh_shapes.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace wall_trouble_test {

/// The water of 2,000 cells in a tank of 1 x 1 x 0.5 m, filled to half.
Scene tankScene(const std::string& wall, const std::filesystem::path& folder) {
  return parseScene(R"({ "format": 1, "particle_spacing": 0.05,
                     "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [1, 0.5, 0.5] } ],
                     "boundary": { "surfaces": [ )" +
                        wall + " ] } }",
                    folder / "scene.json");
}

/// A tank whose mesh is fitted: its edges are rounded, and its planes miss the mesh a little.
TEST(FittedWalls, NoParticleOfAFlushSourceIsLost) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "fitted";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "wall.obj") << testing::objText(testing::blockMesh({0, 0, 0}, {1, 1, 0.5}));
  const auto run = [](Simulation& simulation) {
    while (simulation.time() < 0.3) simulation.advanceFrame();
    return simulation.statistics().energy.mostGained;
  };
  Simulation box(
      tankScene(R"({ "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5] })", folder), 2);
  const double gained = run(box);
  for (const char* degree : {"1", "2"}) {
    SCOPED_TRACE(degree);
    Simulation simulation(
        tankScene(R"({ "shape": "slim", "mesh": "wall.obj", "fluid": "inside", "degree": )" +
                      std::string(degree) + " }",
                  folder),
        2);
    ASSERT_EQ(simulation.view().positions.size(), 2000U);
    // Each stays in its cell.
    for (const Float4& p : simulation.view().positions)
      for (const float x : {p.x, p.y, p.z}) EXPECT_NEAR(x / 0.05F - std::floor(x / 0.05F), 0.5F, 0.25F);
    // A fit is within 1.5 mm, a thousandth of the diagonal: on 2 m^2 of wet walls that takes 3 litres of 250,
    // and lifts the surface by 6 mm.
    EXPECT_LT(run(simulation), gained + 9.81 * 0.006);
    EXPECT_EQ(simulation.statistics().lostParticles, 0);
    for (const Trouble& trouble : simulation.statistics().trouble) EXPECT_EQ(trouble.kind, "not_converged");
  }
  std::filesystem::remove_all(folder);
}

TEST(OverlappingWalls, SharesPastTheirRangeAreTrouble) {
  for (const bool overlap : {true, false}) {
    Scene scene = testing::emptyScene();
    scene.gravity = {0, -9.81, 0};
    testing::addFluid(scene, {-0.2, 0, -0.2}, {0.2, 0.3, 0.2});
    for (int k = 0; k < (overlap ? 12 : 1); ++k)
      scene.surfaces.push_back(
          std::make_shared<Box>(Vec3d(-1, -1, -1), Vec3d(1 + 0.001 * k, 0, 1), Box::Fluid::outside));
    Simulation simulation(scene, 1);
    simulation.advanceFrame();
    const auto& trouble = simulation.statistics().trouble;
    EXPECT_EQ(std::any_of(trouble.begin(), trouble.end(),
                          [](const auto& one) { return one.kind == "gamma_range"; }),
              overlap);
  }
}

}  // namespace wall_trouble_test
}  // namespace migiwa
