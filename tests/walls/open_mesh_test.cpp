// Meshes that enclose nothing: strips as walls, and where one that was to be filled is open.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/slim/shape_import.h"
#include "core/walls/mesh_wall.h"

namespace migiwa {
namespace open_mesh_test {

/// A strip along the unit circle that comes back to itself after so many half turns.
std::string stripText(int halfTurns) {
  constexpr int kSteps = 24;
  std::string text;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSteps, turn = 0.5 * halfTurns * angle;
    for (const double side : {-0.3, 0.3}) {
      const double across = 1 + side * std::cos(turn);
      text += "v " + std::to_string(across * std::cos(angle)) + " " +
              std::to_string(across * std::sin(angle)) + " " + std::to_string(side * std::sin(turn)) + "\n";
    }
  }
  for (int k = 0; k < kSteps; ++k) {
    const bool over = k + 1 == kSteps && halfTurns % 2 == 1;
    const int a = 2 * k + 1, b = a + 1, next = 2 * ((k + 1) % kSteps) + 1;
    const int c = next + (over ? 1 : 0), d = next + (over ? 0 : 1);
    for (const auto& [p, q, r] : {std::array{a, c, d}, std::array{a, d, b}})
      text += "f " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
  }
  return text;
}

TEST(MeshWall, AMoebiusStripIsASheetThatIsWetAllOver) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "strip.obj";
  for (const int halfTurns : {0, 1, 2, 3}) {
    std::ofstream(file) << stripText(halfTurns);
    const std::vector<WallTriangle> faces = wallFaces(importShape(file).mesh, false, "test");
    EXPECT_EQ(faces.size(), 48U);
    EXPECT_TRUE(std::all_of(faces.begin(), faces.end(), [](const auto& face) { return face.sheet; }));
    const TriangleTree tree(faces);
    // Off both sides of it, all the way round.
    for (const WallTriangle& face : faces) {
      const Vec3f middle = (face.corners[0] + face.corners[1] + face.corners[2]) / 3;
      for (const float side : {-0.02F, 0.02F})
        EXPECT_NEAR(tree.nearest(middle + side * face.normal).distance, 0.02F, 1e-4F);
    }
  }
  std::filesystem::remove(file);
}

TEST(MeshSource, SaysWhereAMeshIsOpen) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "open.obj";
  // A tetrahedron without its floor.
  std::ofstream(file) << "v 0 0 0\nv 2 0 0\nv 0 0 2\nv 0 2 0\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  try {
    parseScene(R"({ "format": 1, "fluid": [ { "shape": "mesh", "file": ")" + file.string() + R"(" } ] })",
               file.parent_path() / "scene.json");
    FAIL() << "expected a fault";
  } catch (const InputError& error) {
    const std::string said = error.what();
    EXPECT_NE(
        said.find("found one that is open: 3 edges have a triangle on one side only, the first near (0, "
                  "0, 1)"),
        std::string::npos)
        << said;
    EXPECT_NE(said.find("fill its holes in a mesh program"), std::string::npos) << said;
  }
  std::filesystem::remove(file);
}

}  // namespace open_mesh_test
}  // namespace migiwa
