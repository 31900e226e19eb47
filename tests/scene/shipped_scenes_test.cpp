// What is true of every scene in scenes/, and of each one by itself.
#include <filesystem>

#include <gtest/gtest.h>

#include "core/scene/particle_limit.h"
#include "core/scene/scene_reader.h"

namespace migiwa {
namespace {

const std::filesystem::path kScenes = MIGIWA_SOURCE_DIR "/scenes";

TEST(ShippedScenes, AllAreReadAndSayWhatTheyShow) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    SCOPED_TRACE(entry.path());
    ++scenes;
    const Scene scene = readScene(entry.path());
    EXPECT_GT(scene.name.size(), 3U);
    EXPECT_NE(scene.name, scene.stem()) << "has a name of its own";
    EXPECT_GT(scene.description.size(), 60U);
    EXPECT_TRUE(scene.warnings.empty());
  }
  EXPECT_GE(scenes, 3);
}

TEST(ShippedScenes, AllFluidStartsInsideTheWalls) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    SCOPED_TRACE(entry.path());
    const Scene scene = readScene(entry.path());
    const double margin = 0.499 * scene.particleSpacing;
    for (const auto& source : scene.fluid) {
      std::vector<Vec3d> centers;
      source->fill(scene.particleSpacing, centers);
      Vec3f normal;
      for (const Vec3d& p : centers)
        for (const auto& surface : scene.surfaces)
          ASSERT_GE(static_cast<double>(surface->distance(p.cast<float>(), normal)), margin) << p.transpose();
    }
  }
}

TEST(ShippedScenes, DamBreakIsThePapers) {
  const Scene scene = readScene(kScenes / "dam_break.json");
  EXPECT_EQ(particleCount(scene), 9216);
  EXPECT_EQ(scene.solver.tolerance, 0.03);
  EXPECT_EQ(scene.solver.maxIterations, 20);
  EXPECT_TRUE(scene.view.clip.enabled);
  EXPECT_EQ(scene.view.clip.at, 0.8) << "the middle plane of the tank";
}

TEST(ShippedScenes, StillTankIsFullFromWallToWall) {
  const Scene scene = readScene(kScenes / "still_tank.json");
  EXPECT_EQ(particleCount(scene), 7200);
  EXPECT_EQ(scene.solver.tolerance, 0.01);
  EXPECT_EQ(scene.duration, 3);
  const Vec3d fluid = scene.fluid.at(0)->bounds().size();
  const Vec3d tank = scene.surfaces.at(0)->bounds().size();
  EXPECT_NEAR(fluid.x(), tank.x(), 1e-12);
  EXPECT_NEAR(fluid.z(), tank.z(), 1e-12);
}

TEST(ShippedScenes, CornerDropHasAFewThousandParticles) {
  const Scene scene = readScene(kScenes / "corner_drop.json");
  EXPECT_GT(particleCount(scene), 2000);
  EXPECT_LT(particleCount(scene), 5000);
  EXPECT_EQ(scene.duration, 2);
}

}  // namespace
}  // namespace migiwa
