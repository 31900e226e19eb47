// Scenes whose parts do not go together: other units, other places, too little water.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/fill.h"
#include "tests/support/mesh_shapes.h"

namespace migiwa::testing {
namespace places_test {

/// A rod of `size` (m) along x at `corner` in a file of the test's own.
class Places : public ::testing::Test {
 protected:
  ~Places() override { std::filesystem::remove(file_); }

  /// Warnings of a tank of 2 m, half full, with a mesh of so many metres in it.
  std::vector<std::string> warningsWith(double size, const Vec3d& corner) {
    {
      const TriangleMesh mesh = boxMesh(corner, {size, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5});
      std::ofstream out(file_);
      for (const Vec3f& v : mesh.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
      for (const auto& [a, b, c] : mesh.triangles)
        out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
    }
    return parseScene(R"({ "format": 1, "particle_spacing": 0.1, "fluid": [
        { "shape": "mesh", "file": ")" +
                          file_.string() + "\"" + R"( },
        { "shape": "sphere", "center": [1, 0.5, 0.5], "radius": 0.5 }],
        "boundary": { "surfaces": [
          { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [2, 1, 1] }] } })",
                      "places.json")
        .warnings;
  }

  std::filesystem::path file_ = std::filesystem::path(::testing::TempDir()) / "places.obj";
};

TEST_F(Places, MillimetresAmongMetresAreNamedWithBothSizesAndTheRemedy) {
  EXPECT_TRUE(warningsWith(0.5, {0.3, 0.2, 0.1}).empty());
  // 300 mm.
  const auto warnings = warningsWith(300, {100, 200, 100});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "/fluid/0: its largest side is 300 m, and that of all else together 2 m; if the file is in "
            "millimetres, \"transform\": {\"scale\": 0.001} makes them metres");
  EXPECT_TRUE(warningsWith(190, {0, 0, 0}).empty()) << "less than a hundred times";
}

TEST_F(Places, AMeshNowhereNearTheRestIsNamedWithTheGap) {
  const auto warnings = warningsWith(0.5, {7, 0, 0});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "/fluid/0: it is 5 m away from all else, whose largest side is 2 m; its own is 0.5 m; "
            "\"transform\": {\"translate\": ..., \"scale\": ...} puts it in its place");
  EXPECT_TRUE(warningsWith(0.5, {3.9, 0, 0}).empty());
}

TEST(Placed, WallsFarFromTheFluidAreNamed) {
  const auto warnings = [](double x) {
    return parseScene(R"({ "format": 1, "particle_spacing": 0.1, "fluid": [
        { "shape": "box", "min": [0, 0, 0], "max": [1, 1, 1] }], "boundary": { "surfaces": [
        { "shape": "box", "fluid": "outside", "min": [)" +
                          std::to_string(x) + R"(, 0, 0], "max": [)" + std::to_string(x + 2) +
                          R"(, 1, 1] }] } })",
                      "apart.json")
        .warnings;
  };
  EXPECT_TRUE(warnings(2.9).empty());
  ASSERT_EQ(warnings(4).size(), 1U);
  EXPECT_EQ(warnings(4)[0],
            "/boundary/surfaces: it is 3 m away from the fluid, whose largest side is 1 m; its own is 2 m. "
            "Check the coordinates");
}

TEST(Placed, WaterOfAFewLayersIsSaidToBeTooThin) {
  const auto warnings = [](double height, const std::string& gravity) {
    Scene scene = parseScene(R"({ "format": 1, "particle_spacing": 0.1, "gravity": )" + gravity +
                                 R"(, "fluid": [{ "shape": "box", "min": [0, 0, 0], "max": [1, )" +
                                 std::to_string(height) + R"(, 1] }] })",
                             "thin.json");
    Particles particles;
    fillScene(scene, Boundary(scene.surfaces), particles);
    return scene.warnings;
  };
  const std::string down = "[0, -9.81, 0]";
  for (const int layers : {1, 2, 3}) {
    ASSERT_EQ(warnings(0.1 * layers, down).size(), 1U) << layers;
    EXPECT_TRUE(warnings(0.1 * layers, down)[0].starts_with("/particle_spacing: the fluid is " +
                                                            std::to_string(layers) + " layer"))
        << warnings(0.1 * layers, down)[0];
  }
  EXPECT_NE(warnings(0.2, down)[0].find("a particle_spacing of 0.025 m makes 8 of them"), std::string::npos);
  EXPECT_TRUE(warnings(0.4, down).empty());
  EXPECT_TRUE(warnings(0.1, "[0, 0, 0]").empty());
  EXPECT_TRUE(warnings(0.2, "[-9.81, 0, 0]").empty()) << "ten layers along gravity";
}

}  // namespace places_test
}  // namespace migiwa::testing
