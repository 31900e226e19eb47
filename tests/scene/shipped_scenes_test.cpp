// What is true of every scene in scenes/, and of each one by itself.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/fill.h"
#include "core/walls/boundary.h"

namespace migiwa {
namespace shipped_scenes_test {

const std::filesystem::path kScenes = MIGIWA_SOURCE_DIR "/scenes";

/// Particles of all sources before trimming.
double filled(const Scene& scene) {
  std::vector<Vec3d> centers;
  for (const auto& source : scene.fluid) source->fill(scene.particleSpacing, centers);
  return static_cast<double>(centers.size());
}

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
    EXPECT_EQ(scene.origin, Vec3d(0, 0, 0));
  }
  EXPECT_GE(scenes, 3);
}

TEST(ShippedScenes, OriginIsZeroInEveryFolderUnlessTheSceneIsFar) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    const bool far = entry.path().stem() == "far_origin";
    EXPECT_EQ(readScene(entry.path()).origin, far ? Vec3d(10000, 0, 10000) : Vec3d(0, 0, 0)) << entry.path();
  }
}

TEST(ShippedScenes, AllFluidStartsInsideTheWalls) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    SCOPED_TRACE(entry.path());
    Scene scene = readScene(entry.path());
    const double margin = 0.499 * scene.particleSpacing;
    const Boundary boundary(scene.surfaces);
    Particles particles;
    fillScene(scene, boundary, particles);
    for (const Float4& p : particles.position)
      ASSERT_GE(static_cast<double>(boundary.distance(p.xyz())), margin) << p.xyz().transpose();
    // Only a vessel without flat walls is filled by trimming.
    const bool flat =
        std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [](const auto& s) { return s->planar(); });
    for (const std::string& warning : scene.warnings) {
      EXPECT_FALSE(flat) << warning;
      EXPECT_NE(warning.find("lie within or too near the walls"), std::string::npos) << warning;
    }
    if (flat) {
      EXPECT_EQ(static_cast<double>(particles.size()), filled(scene)) << "trimmed by a wall";
    }
  }
}

TEST(ShippedScenes, DamBreakIsThePapers) {
  const Scene scene = readScene(kScenes / "dam_break.json");
  EXPECT_EQ(particleCount(scene), 9216);
  EXPECT_EQ(scene.solver.maxIterations, 20);
  EXPECT_TRUE(scene.view.clip.enabled);
  EXPECT_EQ(scene.view.clip.at, 0.8) << "the middle plane of the tank";
}

TEST(ShippedScenes, StillTankIsFullFromWallToWall) {
  const Scene scene = readScene(kScenes / "still_tank.json");
  EXPECT_EQ(particleCount(scene), 7200);
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

TEST(ShippedScenes, BowlIsThePapers) {
  const Scene scene = readScene(kScenes / "bowl.json");
  EXPECT_NEAR(filled(scene), 12000, 200);
  EXPECT_EQ(scene.solver.maxIterations, 10);
  // Both sides of the wall, and the rounded rim, where the formula says.
  Vec3f normal;
  EXPECT_NEAR(scene.surfaces.at(0)->distance({0, -1.1F, 0}, normal), 0.1F, 0.01F);
  EXPECT_NEAR(scene.surfaces.at(0)->distance({0, -1.3F, 0}, normal), -0.1F, 0.03F);
  EXPECT_NEAR(scene.surfaces.at(0)->distance({1.3F, 0.2F, 0}, normal), 0.1F, 0.01F);
}

}  // namespace shipped_scenes_test
}  // namespace migiwa
