// Meshes and SLIM surfaces as scenes name them: relative files, transforms, warnings and faults; meshes as
// fluid.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/scene/sources.h"
#include "core/slim/file.h"
#include "core/walls/slim_wall.h"

namespace migiwa {
namespace slim_scene_test {

namespace fs = std::filesystem;

const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

/// A folder with a scene and a mesh beside it.
class SlimScene : public ::testing::Test {
 protected:
  SlimScene() {
    folder_ = fs::temp_directory_path() / (std::string("migiwa_slim_scene_") +
                                           ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_ / "meshes");
    std::ofstream(folder_ / "meshes" / "cube.obj") << kCube;
  }
  ~SlimScene() override { fs::remove_all(folder_); }

  Scene read(const std::string& surface, const std::string& fluid = "") const {
    std::ofstream(folder_ / "scene.json") << R"({ "format": 1, "fluid": [)" << fluid
                                          << R"(], "boundary": { "surfaces": [)" << surface << "] } }";
    return readScene(folder_ / "scene.json");
  }
  std::string faultOf(const std::string& surface) const {
    try {
      read(surface);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string place = (folder_ / "scene.json").string() + ":";
      EXPECT_TRUE(text.starts_with(place)) << text;
      return text.substr(place.size());
    }
    return "accepted";
  }

  fs::path folder_;
};

TEST_F(SlimScene, AMeshIsFoundBesideTheSceneAndTransformed) {
  const Scene scene = read(R"({ "shape": "mesh", "file": "meshes/cube.obj", "fluid": "outside",
      "transform": { "scale": 2, "rotate": { "axis": [0, 0, 1], "degrees": 90 }, "translate": [10, 0, 0] } })");
  ASSERT_EQ(scene.surfaces.size(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
  // Twice as large, and turned: x in [8, 10], y and z in [0, 2].
  Vec3f normal;
  EXPECT_NEAR(scene.surfaces[0]->distance({9, 2.1F, 1}, normal), 0.1F, 0.005F);
  EXPECT_NEAR(normal.y(), 1, 0.01F);
  EXPECT_NEAR(scene.surfaces[0]->distance({7.9F, 1, 1}, normal), 0.1F, 0.005F);
  EXPECT_LT(scene.surfaces[0]->distance({9, 1, 1}, normal), -0.9F);
}

TEST_F(SlimScene, TheWriterKeepsEveryKey) {
  const Scene scene =
      read(R"({ "shape": "slim", "mesh": "meshes/cube.obj", "fluid": "inside", "degree": 1, "nodes": 300 },
      { "shape": "slim", "fluid": "outside", "bowl": { "center": [3, 0, 0], "radius": 1, "thickness": 0.2 }, "degree": 1, "tolerance": 0.01 },
      { "shape": "mesh", "file": "meshes/cube.obj", "fluid": "inside" })",
           R"({ "shape": "mesh", "file": "meshes/cube.obj" })");
  const std::string text = writeScene(scene);
  EXPECT_NE(text.find("\"mesh\": \"meshes/cube.obj\""), std::string::npos) << text;
  EXPECT_NE(text.find("\"nodes\": 300"), std::string::npos);
  EXPECT_NE(text.find("\"thickness\": 0.2"), std::string::npos);
  EXPECT_EQ(writeScene(parseScene(text, folder_ / "again.json")), text);
}

TEST_F(SlimScene, AFileOfMigiwaSlimIsReadAndTransformed) {
  ThreadPool pool(1);
  SlimFitOptions options;
  options.degree = 3;
  options.tolerance = 0.01;
  std::ofstream(folder_ / "cube.json")
      << slimFileText(fitShape(importShape(folder_ / "meshes" / "cube.obj"), options, pool));
  const Scene scene = read(R"({ "shape": "slim", "file": "cube.json", "fluid": "inside",
      "transform": { "scale": 3, "translate": [0, 5, 0] } })");
  Vec3f normal;
  EXPECT_NEAR(scene.surfaces[0]->distance({1.5F, 5.2F, 1.5F}, normal), 0.2F, 0.01F);
  EXPECT_NEAR(normal.y(), 1, 0.02F);
}

TEST_F(SlimScene, FaultsNameThePlaceAndTheFile) {
  const std::string place = "/boundary/surfaces/0";
  EXPECT_EQ(faultOf(R"({ "shape": "mesh", "file": "none.obj", "fluid": "inside" })"),
            place + "/file: expected a mesh or a point cloud, found no such file (" +
                (folder_ / "none.obj").string() + ")");
  EXPECT_EQ(faultOf(R"({ "shape": "slim", "file": "meshes/cube.obj", "fluid": "inside" })"),
            place + "/file: expected a file of a SLIM surface (JSON), found one that ends or breaks here (" +
                (folder_ / "meshes/cube.obj").string() + ":byte 1)");
  EXPECT_EQ(faultOf(R"({ "shape": "slim", "fluid": "inside" })"),
            place + ": expected one of \"file\", \"mesh\" and \"bowl\", found none");
  EXPECT_EQ(
      faultOf(
          R"({ "shape": "slim", "fluid": "inside", "mesh": "meshes/cube.obj", "tolerance": 1, "nodes": 9 })"),
      place + "/nodes: expected either tolerance or nodes, found both");
  EXPECT_EQ(
      faultOf(
          R"({ "shape": "slim", "fluid": "inside", "bowl": { "center": [0, 0, 0], "radius": 1, "thickness": 2 } })"),
      place + "/bowl/thickness: expected less than the radius, found more");
}

TEST_F(SlimScene, AnOpenMeshIsAWarning) {
  std::string open = kCube;
  open.erase(open.find("f 5 6 7 8\n"), 10);
  std::ofstream(folder_ / "open.obj") << open;
  const Scene scene = read(R"({ "shape": "mesh", "file": "open.obj", "fluid": "outside" })");
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_TRUE(scene.warnings[0].starts_with("/boundary/surfaces/0/file: ")) << scene.warnings[0];
  EXPECT_NE(scene.warnings[0].find("the mesh is open"), std::string::npos) << scene.warnings[0];
  EXPECT_THROW(read("", R"({ "shape": "mesh", "file": "open.obj" })"), InputError) << "fluid needs an inside";
}

TEST_F(SlimScene, AMeshOfFluidIsFilledAsABoxIs) {
  const Scene scene =
      read("", R"({ "shape": "mesh", "file": "meshes/cube.obj", "transform": { "translate": [0, 0, 1] } })");
  std::vector<Vec3d> centers;
  scene.fluid.at(0)->fill(0.1, centers);
  ASSERT_EQ(centers.size(), 1000U);
  for (const Vec3d& p : centers) {
    ASSERT_GT(p.minCoeff(), 0.049);
    ASSERT_LT(p.x(), 0.951);
    ASSERT_GT(p.z(), 1.049);
  }
  EXPECT_GE(scene.fluid[0]->count(0.1), 1000);
  EXPECT_LT(scene.fluid[0]->count(0.1), 1700);
}

}  // namespace slim_scene_test
}  // namespace migiwa
