// The surface of scenes in motion.
#include "core/simulation/scene_surface.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/support/test_scenes.h"
#include "tests/surface/mesh_checks.h"

namespace migiwa {
namespace scene_surface_test {

using testing::crossingsOf;
using testing::faultsOf;

/// A scene that runs, with its surface.
class Running {
 public:
  explicit Running(const Scene& scene) : simulation_(scene, 2), surface_(simulation_.scene(), {}, pool_) {}

  /// False where the run has stopped before.
  bool runTo(double time) {
    while (simulation_.time() < time - 1e-9 && !simulation_.stopped()) simulation_.advanceFrame();
    return !simulation_.stopped();
  }
  SurfaceMesh mesh() {
    const FrameView view = simulation_.view();
    return surface_.mesh(view.positions, view.velocities, simulation_.time());
  }
  /// That of the particles: what each takes at rest, or less where the fluid is denser than that (m^3).
  double volume() const {
    const FrameView view = simulation_.view();
    double sum = 0;
    for (const float density : view.density) sum += 1 / std::max(1.0, static_cast<double>(density));
    return sum * std::pow(simulation_.scene().particleSpacing, 3);
  }
  const Simulation& simulation() const { return simulation_; }
  const Boundary& boundary() const { return surface_.boundary(); }
  double spacing() const { return simulation_.scene().particleSpacing; }

 private:
  Simulation simulation_;
  ThreadPool pool_{2};
  SceneSurface surface_;
};

const std::vector<Override> kPositions{{"/solver/velocity_step", "positions"},
                                       {"/effects/viscosity/xsph", "0.05"}};

std::set<std::uint32_t> wetVertices(const SurfaceMesh& mesh) {
  std::set<std::uint32_t> wet;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.wet[t] != 0) wet.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
  return wet;
}

void expectSound(const SurfaceMesh& mesh, const Running& run, const std::string& what) {
  EXPECT_EQ(faultsOf(mesh).total(), 0) << what;
  double farthest = 0;
  for (const std::uint32_t v : wetVertices(mesh))
    farthest = std::max(farthest, std::abs(static_cast<double>(run.boundary().distance(mesh.positions[v]))));
  EXPECT_LT(farthest, 0.001 * run.spacing()) << what;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    ASSERT_TRUE(mesh.positions[v].allFinite() && mesh.velocities[v].allFinite()) << what;
    ASSERT_NEAR(mesh.normals[v].norm(), 1, 1e-4) << what;
  }
}

// The volume that a mesh encloses is that of the water, which velocities from positions keep dense up to its
// surface. By projection the layers at the surface lie looser while they move, by a sixth of a spacing: that
// is the water's, not the mesh's.
TEST(SceneSurface, OfADamBreakKeepsTheVolume) {
  Running run(readScene(std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes/dam_break.json", kPositions));
  for (const double time : {0.0, 0.3, 0.6, 0.9}) {
    ASSERT_TRUE(run.runTo(time));
    const SurfaceMesh mesh = run.mesh();
    const std::string what = std::to_string(time);
    expectSound(mesh, run, what);
    EXPECT_EQ(crossingsOf(mesh, run.spacing(), 1e-3 * run.spacing()), 0) << what;
    EXPECT_NEAR(enclosedVolume(mesh) / run.volume(), 1, 0.01) << what;
  }
}

TEST(SceneSurface, OfAStillTankIsLevelAndAtRest) {
  Running run(readScene(std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes/still_tank.json", {}));
  ASSERT_TRUE(run.runTo(2));
  const auto heights = [&](const SurfaceMesh& mesh) {
    std::map<std::string, std::vector<double>> of;
    const std::set<std::uint32_t> wet = wetVertices(mesh);
    std::set<std::uint32_t> free;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.wet[t] == 0) free.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
    for (const std::uint32_t v : free)
      of[wet.contains(v) ? "walls" : "middle"].push_back(static_cast<double>(mesh.positions[v].y()) /
                                                         run.spacing());
    return of;
  };
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  const SurfaceMesh mesh = run.mesh();
  expectSound(mesh, run, "at rest");
  EXPECT_NEAR(enclosedVolume(mesh) / run.volume(), 1, 0.01);
  auto level = heights(mesh);
  double squares = 0;
  for (const double height : level["middle"]) squares += std::pow(height - mean(level["middle"]), 2);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(level["middle"].size())), 0.05);
  EXPECT_NEAR(mean(level["walls"]), mean(level["middle"]), 0.05);

  // A tenth of a second later the surface has moved no more than twice as far as the particles.
  const auto particlesById = [&] {
    std::map<std::uint32_t, Vec3d> places;
    const FrameView view = run.simulation().view();
    for (std::size_t k = 0; k < view.ids.size(); ++k)
      places[view.ids[k]] = view.positions[k].xyz().cast<double>();
    return places;
  };
  const auto before = particlesById();
  ASSERT_TRUE(run.runTo(2.1));
  double moved = 0;
  for (const auto& [id, place] : particlesById()) moved += (place - before.at(id)).squaredNorm();
  moved = std::sqrt(moved / static_cast<double>(before.size())) / run.spacing();
  // Heights over columns of the grid, where there is a vertex at both times.
  const auto columns = [&](const SurfaceMesh& of) {
    std::map<std::pair<int, int>, double> height;
    const std::set<std::uint32_t> wet = wetVertices(of);
    const double cell = 0.5 * run.spacing();
    for (std::uint32_t v = 0; v < of.positions.size(); ++v)
      if (!wet.contains(v))
        height[{static_cast<int>(std::floor(static_cast<double>(of.positions[v].x()) / cell)),
                static_cast<int>(std::floor(static_cast<double>(of.positions[v].z()) / cell))}] =
            static_cast<double>(of.positions[v].y()) / run.spacing();
    return height;
  };
  const auto first = columns(mesh), second = columns(run.mesh());
  double change = 0;
  long count = 0;
  for (const auto& [column, height] : first)
    if (const auto same = second.find(column); same != second.end())
      change += std::pow(same->second - height, 2), ++count;
  ASSERT_GT(count, 1000);
  EXPECT_LT(std::sqrt(change / static_cast<double>(count)), 2 * moved);
}

TEST(SceneSurface, ByProjectionADamBreakSwellsLittle) {
  Running run(readScene(std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes/dam_break.json", {}));
  for (const double time : {0.0, 0.3, 0.6, 0.9}) {
    ASSERT_TRUE(run.runTo(time));
    const SurfaceMesh mesh = run.mesh();
    expectSound(mesh, run, std::to_string(time));
    EXPECT_NEAR(enclosedVolume(mesh) / run.volume(), 1, time > 0 ? 0.045 : 0.01) << time;
  }
}

TEST(SceneSurface, FollowsWallsThatMove) {
  Running run(readScene(std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes/stirred_tank.json", kPositions));
  for (const double time : {0.0, 0.25, 0.5}) {
    ASSERT_TRUE(run.runTo(time));
    const SurfaceMesh mesh = run.mesh();
    expectSound(mesh, run, std::to_string(time));
    EXPECT_EQ(crossingsOf(mesh, run.spacing(), 0.02 * run.spacing()), 0) << time;
    EXPECT_NEAR(enclosedVolume(mesh) / run.volume(), 1, 0.01) << time;
  }
}

TEST(SceneSurface, KeepsTheSidesOfAThinWallApart) {
  Running run(readScene(std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes/thin_wall.json", {}));
  ASSERT_TRUE(run.runTo(0.3));
  const SurfaceMesh mesh = run.mesh();
  expectSound(mesh, run, "thin wall");
  EXPECT_NEAR(enclosedVolume(mesh) / run.volume(), 1, 0.01);
  // The shallow side is dry far above its water, and no water is in the plate.
  for (const Vec3f& p : mesh.positions) EXPECT_FALSE(p.x() > 0.63F && p.y() > 0.45F) << p.transpose();
}

/// Every shipped scene at five times of its first second and a half, moving walls included.
class EveryScene : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryScene, HasAClosedSurface) {
  const std::filesystem::path file =
      std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes" / (GetParam() + ".json");
  const Scene scene = readScene(file, {});
  Running run(scene);
  const double end = std::min(scene.duration, 1.5);
  for (int k = 0; k < 5; ++k) {
    if (!run.runTo(end * k / 4)) break;
    const SurfaceMesh mesh = run.mesh();
    const std::string what = GetParam() + " at " + std::to_string(run.simulation().time());
    EXPECT_EQ(faultsOf(mesh).total(), 0) << what;
    // These walls are broken on purpose: their distances jump, so that no point of them is at a distance of
    // zero.
    if (GetParam() == "hard/slim_shell_crossing" || GetParam() == "hard/slim_shell_holed") continue;
    expectSound(mesh, run, what);
    EXPECT_LE(crossingsOf(mesh, run.spacing(), 0.02 * run.spacing()),
              static_cast<long>(mesh.triangles.size() / 2000))
        << what;
  }
}

std::vector<std::string> shippedScenes() {
  std::vector<std::string> names;
  for (const char* folder : {"", "hard", "truth"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes" / folder)) {
      const std::string name = entry.path().filename().string();
      if (!name.ends_with(".json") || name == "scene.schema.json") continue;
      names.push_back((*folder != '\0' ? std::string(folder) + "/" : std::string()) +
                      entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryScene, ::testing::ValuesIn(shippedScenes()), [](const auto& named) {
  std::string name = named.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

}  // namespace scene_surface_test
}  // namespace migiwa
