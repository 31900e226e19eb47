// Water at walls from mesh files: against the same walls as shapes, and against what mechanics allows.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/support/mesh_shapes.h"

namespace migiwa {
namespace mesh_scene_test {

namespace fs = std::filesystem;
using testing::ballMesh;
using testing::blockMesh;
using testing::together;
using testing::tubeMesh;
using testing::windingNumber;

/// A cup: a disc with a wall about it, open at the top. With a thickness it is closed: two shells and a rim.
TriangleMesh cupMesh(double radius, double height, double thickness) {
  constexpr std::uint32_t kSides = 24;
  TriangleMesh mesh;
  // Rings of vertices from the middle of the floor outwards and up, and back on the outside.
  std::vector<std::pair<double, double>> profile{{0, 0}, {radius, 0}, {radius, height}};
  if (thickness > 0) {
    profile.insert(profile.end(),
                   {{radius + thickness, height}, {radius + thickness, -thickness}, {0, -thickness}});
  }
  std::vector<std::vector<std::uint32_t>> rings;
  for (const auto& [r, y] : profile) {
    std::vector<std::uint32_t>& ring = rings.emplace_back();
    for (std::uint32_t k = 0; k < kSides; ++k) {
      if (r > 0 || k == 0) {
        const double turn = 2 * std::numbers::pi * k / kSides;
        mesh.vertices.push_back(Vec3d(r * std::cos(turn), y, r * std::sin(turn)).cast<float>());
      }
      ring.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
    }
  }
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t next = (k + 1) % kSides;
      const std::uint32_t a = rings[ring][k], b = rings[ring][next], c = rings[ring + 1][k],
                          d = rings[ring + 1][next];
      if (a != b) mesh.triangles.push_back({a, b, d});
      if (c != d) mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

class MeshScene : public ::testing::Test {
 protected:
  MeshScene() {
    folder_ = fs::temp_directory_path() / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
  }
  ~MeshScene() override { fs::remove_all(folder_); }

  /// A scene with this mesh as wall.obj.
  Scene scene(const TriangleMesh& mesh, const std::string& text) const {
    std::ofstream(folder_ / "wall.obj") << testing::objText(mesh);
    return parseScene(text, folder_ / "scene.json");
  }

  fs::path folder_;
};

std::string wallText(const std::string& fluid) {
  return R"({ "shape": "mesh", "file": "wall.obj", "fluid": ")" + fluid + "\" }";
}

std::string sceneText(double spacing, const std::string& fluid, const std::string& walls) {
  return R"({ "format": 1, "particle_spacing": )" + std::to_string(spacing) + R"(, "fluid": [ )" + fluid +
         R"( ], "boundary": { "surfaces": [ )" + walls + " ] } }";
}

/// Potential and kinetic energy over the mass (J/kg).
double energyOf(const FrameView& view) {
  double energy = 0;
  for (std::size_t i = 0; i < view.positions.size(); ++i)
    energy += 9.81 * static_cast<double>(view.positions[i].y) +
              0.5 * view.velocities[i].xyz().cast<double>().squaredNorm();
  return energy / static_cast<double>(view.positions.size());
}

void advance(Simulation& simulation, double until) {
  while (simulation.time() < until - 1e-9 && !simulation.stopped()) simulation.advanceFrame();
}

TEST_F(MeshScene, ATankOfTrianglesDoesWhatTheBoxDoes) {
  const std::string water = R"({ "shape": "box", "min": [0, 0, 0], "max": [0.5, 0.4, 0.5] })";
  Simulation mesh(scene(blockMesh({0, 0, 0}, {1, 1, 0.5}), sceneText(0.05, water, wallText("inside"))), 2);
  Simulation box(
      parseScene(sceneText(0.05, water,
                           R"({ "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5] })"),
                 "scene.json"),
      2);
  ASSERT_EQ(mesh.view().positions.size(), 800U);
  advance(mesh, 0.5);
  advance(box, 0.5);
  EXPECT_EQ(mesh.stateHash(), box.stateHash());
}

/// An L-shaped tank: no box, one concave corner of planes. Filled flush with its walls, it keeps its water,
/// and that stands as high as its volume says.
TEST_F(MeshScene, ATankThatIsNoBoxIsFilledFlushAndKeepsItsLevel) {
  const TriangleMesh mesh =
      together({blockMesh({0, 0, 0}, {1, 1, 0.5}), blockMesh({0, 0, 0.5}, {0.5, 1, 1})});
  Simulation simulation(scene(mesh, sceneText(0.05,
                                              R"({ "shape": "box", "min": [0, 0, 0], "max": [1, 0.5, 0.5] },
                               { "shape": "box", "min": [0, 0, 0.5], "max": [0.5, 0.5, 1] })",
                                              wallText("inside"))),
                        2);
  ASSERT_EQ(simulation.view().positions.size(), 3000U);
  advance(simulation, 2);
  double height = 0;
  for (const Float4& p : simulation.view().positions) height += 2 * static_cast<double>(p.y) / 3000;
  EXPECT_NEAR(height, 0.5, 0.01);
  EXPECT_FALSE(simulation.stopped());
}

/// A floor with a partition on it, three sheets at one edge: no particle ever passes one of them, and those
/// on the left go round the partition at its ends only.
TEST_F(MeshScene, NoWaterPassesSheetsThatMeetAtAnEdge) {
  const TriangleMesh mesh = together({testing::sheetMesh({-0.4, 0, 0.4}, {0.4, 0, 0}, {0, 0, -0.8}),
                                      testing::sheetMesh({0, 0, 0.4}, {0.4, 0, 0}, {0, 0, -0.8}),
                                      testing::sheetMesh({0, 0, 0.4}, {0, 0, -0.8}, {0, 0.5, 0})});
  for (const char* fluid : {"outside", "inside"}) {
    Simulation simulation(
        scene(mesh,
              sceneText(0.04, R"({ "shape": "box", "min": [-0.36, 0.04, -0.2], "max": [-0.04, 0.4, 0.2] })",
                        wallText(fluid))),
        2);
    std::map<std::uint32_t, Vec3d> before;
    while (simulation.time() < 1) {
      const FrameView view = simulation.view();
      for (std::size_t i = 0; i < view.positions.size(); ++i) {
        const Vec3d now = view.positions[i].xyz().cast<double>();
        const auto [known, isNew] = before.try_emplace(view.ids[i], now);
        if (!isNew) {
          ASSERT_FALSE(testing::meets(mesh, known->second, now)) << "at " << simulation.time() << " s";
        }
        known->second = now;
      }
      simulation.advanceFrame();
      ASSERT_FALSE(simulation.stopped());
    }
    EXPECT_GT(before.size(), 500U);
  }
}

TEST_F(MeshScene, WaterRunsOffAnOpenSheetAndFallsWithoutEnergyFromNowhere) {
  // 0.8 m wide, of squares of 0.2 m.
  std::vector<TriangleMesh> squares;
  for (int x = -2; x < 2; ++x)
    for (int z = -2; z < 2; ++z)
      squares.push_back(testing::sheetMesh({0.2 * x, 0, 0.2 * z + 0.2}, {0.2, 0, 0}, {0, 0, -0.2}));
  Simulation simulation(
      scene(together(squares),
            sceneText(0.04, R"({ "shape": "box", "min": [-0.2, 0.06, -0.2], "max": [0.2, 0.4, 0.2] })",
                      wallText("outside"))),
      2);
  const double start = energyOf(simulation.view());
  double highest = start;
  while (simulation.time() < 1.2) {
    simulation.advanceFrame();
    highest = std::max(highest, energyOf(simulation.view()));
    for (const Float4& p : simulation.view().positions) {
      // Above the sheet until it is past the rim: nothing goes through.
      if (std::max(std::abs(p.x), std::abs(p.z)) < 0.38F && simulation.time() < 0.25) {
        ASSERT_GE(p.y, 0.0F);
      }
      ASSERT_LE(p.y, 0.45F);
    }
  }
  EXPECT_LE(highest, start + 0.02);
  const auto fallen = std::count_if(simulation.view().positions.begin(), simulation.view().positions.end(),
                                    [](const Float4& p) { return p.y < -0.1F; });
  EXPECT_GT(fallen, static_cast<long>(simulation.view().positions.size() * 4 / 5));
}

/// A cup holds what it has room for, with walls of no thickness and of a tenth of a spacing.
TEST_F(MeshScene, ACupOfThinWallsIsTight) {
  for (const double thickness : {0.0, 0.002, 0.004}) {
    Simulation simulation(
        scene(cupMesh(0.2, 0.6, thickness),
              sceneText(0.02, R"({ "shape": "box", "min": [-0.12, 0.01, -0.12], "max": [0.12, 0.35, 0.12] })",
                        wallText("outside"))),
        2);
    advance(simulation, 0.6);
    const auto outside =
        std::count_if(simulation.view().positions.begin(), simulation.view().positions.end(),
                      [](const Float4& p) { return p.y < 0 || std::hypot(p.x, p.z) > 0.2F; });
    EXPECT_EQ(outside, 0) << thickness;
    EXPECT_FALSE(simulation.stopped());
  }
}

TEST_F(MeshScene, ACupWithoutThicknessRunsOverAtItsRim) {
  // 20 litres stand in a cup of 9.4.
  Simulation simulation(
      scene(cupMesh(0.2, 0.075, 0),
            sceneText(0.02, R"({ "shape": "box", "min": [-0.12, 0.01, -0.12], "max": [0.12, 0.35, 0.12] })",
                      wallText("outside"))),
      2);
  advance(simulation, 1.5);
  double within = 0;
  for (const Float4& p : simulation.view().positions) {
    if (p.y < 0 || std::hypot(p.x, p.z) > 0.2F) continue;
    within += 0.02 * 0.02 * 0.02;
    EXPECT_LT(p.y, 0.16F);  // nothing stands above the rim as in a chimney
  }
  EXPECT_GT(within, 0.5 * 0.0094);
  EXPECT_LT(within, 1.25 * 0.0094);
}

/// Boxes, balls and tubes that overlap, touch or nest, in a tank full of water: none starts or gets inside,
/// none is lost, and no energy comes from nowhere.
TEST_F(MeshScene, RandomUnionsAreSolids) {
  std::mt19937 random(11), anywhere(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 200; ++round) {
    std::vector<TriangleMesh> parts;
    const std::size_t count = 2 + random() % 3;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3d middle = Vec3d(0.5, 0.5, 0.5) + 0.25 * Vec3d(unit(random), unit(random), unit(random));
      switch (random() % 3) {
        case 0:
          parts.push_back(blockMesh(middle - Vec3d::Constant(0.12), middle + Vec3d(0.12, 0.2, 0.16)));
          break;
        case 1:
          parts.push_back(ballMesh(middle, 0.18 + 0.05 * unit(random), 8));
          break;
        default:
          parts.push_back(
              tubeMesh(middle, middle + 0.4 * Vec3d(unit(random), unit(random), unit(random)), 0.12, 9));
      }
    }
    const TriangleMesh mesh = together(parts);
    Simulation simulation(
        scene(mesh,
              R"({ "format": 1, "particle_spacing": 0.08, "boundary": { "gamma": { "method": "directions" },
                 "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 1] }, )" +
                  wallText("outside") +
                  R"( ] }, "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [1, 0.8, 1] } ] })"),
        2);
    const Scene& made = simulation.scene();
    const auto wall = made.surfaces[1]->forSupport(static_cast<float>(made.supportRadius()));
    for (int k = 0; k < 300; ++k) {
      const Vec3d p = Vec3d(0.5, 0.5, 0.5) + 0.5 * Vec3d(unit(anywhere), unit(anywhere), unit(anywhere));
      Vec3f normal;
      const float distance = (wall != nullptr ? wall : made.surfaces[1])->distance(p.cast<float>(), normal);
      const bool inside = windingNumber(mesh, p) > 0.5;
      if (std::abs(distance) > 1e-5F) {
        ASSERT_EQ(distance < 0, inside) << round << ": " << p.transpose();
      }
    }
    const double start = energyOf(simulation.view());
    const std::size_t filled = simulation.view().positions.size();
    for (const Float4& p : simulation.view().positions)
      ASSERT_LT(windingNumber(mesh, p.xyz().cast<double>()), 0.5) << round;
    for (int frame = 0; frame < 30; ++frame) simulation.advanceFrame();
    ASSERT_FALSE(simulation.stopped()) << round;
    EXPECT_LE(energyOf(simulation.view()), start + 0.05) << round;
    EXPECT_EQ(simulation.statistics().lostParticles, 0) << round;
    EXPECT_EQ(simulation.view().positions.size(), filled) << round;
    for (const Float4& p : simulation.view().positions)
      ASSERT_LT(windingNumber(mesh, p.xyz().cast<double>()), 0.5) << round;
  }
}

}  // namespace mesh_scene_test
}  // namespace migiwa
