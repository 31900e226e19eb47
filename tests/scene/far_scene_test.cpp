// A scene far from zero is the scene at zero: bit by bit where its coordinates have the digits.
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/support/mesh_shapes.h"

namespace migiwa {
namespace far_scene_test {

using namespace migiwa::testing;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const Vec3d kFar(431250, 0, -8700);

std::string at(const Vec3d& place) {
  std::ostringstream text;
  text.precision(17);
  text << '[' << place.x() << ", " << place.y() << ", " << place.z() << ']';
  return text.str();
}

class FarScene : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("migiwa_far_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    writeMesh("ramp.obj", Vec3d::Zero());
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A slab on edge that no axis is along, moved.
  void writeMesh(const std::string& name, const Vec3d& by) const {
    TriangleMesh mesh = boxMesh({1.25, 0, 0.125}, {0.5, 0.25, 0}, {-0.125, 0.25, 0}, {0, 0.125, 0.5});
    std::ofstream out(folder_ / name);
    out.precision(17);
    for (const Vec3f& vertex : mesh.vertices) {
      const Vec3d place = vertex.cast<double>() + by;
      out << "v " << place.x() << ' ' << place.y() << ' ' << place.z() << '\n';
    }
    for (const auto& [a, b, c] : mesh.triangles) out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  }

  /// Water that breaks over a slab, a tap, a drain, a ball that turns about an axis, and a plane above all;
  /// everything moved by `by`.
  std::string text(const Vec3d& by) const {
    const auto p = [&](double x, double y, double z) { return at(by + Vec3d(x, y, z)); };
    return R"({ "format": 1, "name": "far", "particle_spacing": 0.0625, "duration": 1,
      "fluid": [ { "shape": "box", "min": )" +
           p(0, 0, 0) + R"(, "max": )" + p(0.75, 0.75, 0.75) + R"( },
                 { "shape": "sphere", "center": )" +
           p(1.5, 1.25, 0.375) + R"(, "radius": 0.1875 } ],
      "emitters": [ { "shape": "disc", "center": )" +
           p(0.5, 1.25, 0.375) + R"(, "radius": 0.125, "direction": [0, -1, 0], "speed": 1 } ],
      "drains": [ { "shape": "box", "min": )" +
           p(1.75, 0, 0) + R"(, "max": )" + p(2, 0.25, 0.75) + R"( },
                  { "shape": "sphere", "center": )" +
           p(0, 0, 0) + R"(, "radius": 0.125, "start": 0.1 } ],
      "bounds": { "min": )" +
           p(-1, -1, -1) + R"(, "max": )" + p(3, 3, 2) + R"( },
      "boundary": { "surfaces": [
        { "shape": "box", "fluid": "inside", "min": )" +
           p(0, 0, 0) + R"(, "max": )" + p(2, 2, 0.75) + R"( },
        { "shape": "plane", "point": )" +
           p(0, 1.875, 0) + R"(, "normal": [0, -1, 0] },
        { "shape": "mesh", "fluid": "outside", "file": "ramp.obj", "transform": { "translate": )" +
           at(by) + R"( } },
        { "shape": "sphere", "fluid": "outside", "center": )" +
           p(1, 0.5, 0.375) + R"(, "radius": 0.125,
          "motion": { "rotation": { "axis": [0, 0, 1], "point": )" +
           p(1, 0.75, 0.375) + R"(, "degrees_per_second": 180 } } } ] },
      "view": { "camera": { "eye": )" +
           p(1, 1, 5) + R"(, "target": )" + p(1, 0.5, 0.375) + R"( },
                "clip": { "axis": "z", "at": )" +
           std::to_string(by.z() + 0.375) + " } } }";
  }
  Scene scene(const std::string& text) const { return parseScene(text, folder_ / "far.json"); }

  static std::uint64_t hashAfter(const Scene& scene, int frames) {
    Simulation simulation(scene, 2);
    for (int frame = 0; frame < frames; ++frame) simulation.advanceFrame();
    EXPECT_TRUE(simulation.goodState());
    EXPECT_GT(simulation.view().ids.size(), 500U);
    return simulation.stateHash();
  }

  fs::path folder_;
};

TEST_F(FarScene, HasTheStateOfTheOneAtZero) {
  const Scene near = scene(text(Vec3d::Zero())), far = scene(text(kFar));
  EXPECT_EQ(near.origin, Vec3d(0, 0, 0));
  EXPECT_EQ(far.origin, kFar);
  EXPECT_EQ(hashAfter(far, 50), hashAfter(near, 50));
}

TEST_F(FarScene, PicturesShowTheSame) {
  const Scene near = scene(text(Vec3d::Zero())), far = scene(text(kFar));
  EXPECT_TRUE(far.view == near.view);
  // A camera that is left out follows from what is there.
  const auto without = [&](const Vec3d& by) {
    Json json = Json::parse(text(by));
    json.erase("view");
    return scene(json.dump()).view;
  };
  EXPECT_TRUE(without(kFar) == without(Vec3d::Zero()));
}

// The mesh itself has the coordinates of the map, and no transform.
TEST_F(FarScene, TakesMeshesThatAreFarThemselves) {
  writeMesh("ramp_far.obj", kFar);
  Json json = Json::parse(text(kFar));
  Json& wall = json["boundary"]["surfaces"][2];
  wall["file"] = "ramp_far.obj";
  wall.erase("transform");
  EXPECT_EQ(hashAfter(scene(json.dump()), 20), hashAfter(scene(text(Vec3d::Zero())), 20));
}

// Nothing but files says where the scene is.
TEST_F(FarScene, IsFoundByItsFiles) {
  writeMesh("far.obj", kFar);
  const auto onlyFiles = [&](const std::string& entry) {
    return scene(R"({ "format": 1, "particle_spacing": 0.0625, "fluid": [ { "shape": "mesh", )" + entry +
                 " } ] }");
  };
  const Scene inFile = onlyFiles(R"("file": "far.obj")");
  const Scene moved = onlyFiles(R"("file": "ramp.obj", "transform": { "translate": )" + at(kFar) + " }");
  const Scene back = onlyFiles(R"("file": "far.obj", "transform": { "translate": )" + at(-kFar) + " }");
  for (const Scene* far : {&inFile, &moved}) {
    EXPECT_LT((far->origin - kFar).norm(), 10);
    const Bounds bounds = far->bounds();
    EXPECT_LT((bounds.center() + far->origin - kFar - back.bounds().center()).norm(), 1e-5);
  }
  EXPECT_EQ(back.origin, Vec3d(0, 0, 0));
}

TEST_F(FarScene, IsWrittenAsItWasRead) {
  const std::string read = text(kFar);
  const Scene far = scene(read);
  const Json written = Json::parse(writeScene(far)), original = Json::parse(read);
  for (const char* place : {"/fluid/0/min", "/fluid/0/max", "/fluid/1/center", "/emitters/0/center",
                            "/drains/0/min", "/drains/1/center", "/bounds/max", "/boundary/surfaces/0/max",
                            "/boundary/surfaces/1/point", "/boundary/surfaces/2/transform/translate",
                            "/boundary/surfaces/3/center", "/boundary/surfaces/3/motion/rotation/point",
                            "/view/camera/eye", "/view/camera/target", "/view/clip/at"})
    EXPECT_EQ(written.at(Json::json_pointer(place)), original.at(Json::json_pointer(place))) << place;
  EXPECT_EQ(sceneTextWith(read, folder_ / "far.json", far), read);

  // A camera that was moved in the window, to where no double is at that distance, is all that changes.
  Scene turned = far;
  turned.view.camera.eye = {1.1, 0.9, 4.7};
  Json changed = Json::parse(sceneTextWith(read, folder_ / "far.json", turned));
  const auto eye = changed["view"]["camera"]["eye"].get<std::array<double, 3>>();
  EXPECT_NEAR(eye[0], kFar.x() + 1.1, 1e-10);
  EXPECT_EQ(eye[1], 0.9);
  EXPECT_NEAR(eye[2], kFar.z() + 4.7, 1e-11);
  changed["view"]["camera"] = original["view"]["camera"];
  EXPECT_EQ(changed, original);
}

// A ground whose point is at zero, and decimals that no double has.
TEST_F(FarScene, KeepsCoordinatesThatAreNotFar) {
  const Scene far = scene(R"({ "format": 1, "particle_spacing": 0.05,
      "fluid": [ { "shape": "box", "min": [431250.1, 0.1, 0.3], "max": [431250.9, 0.7, 0.9] } ],
      "boundary": { "surfaces": [ { "shape": "plane", "point": [0.1, 0.1, 0.3], "normal": [0, 1, 0] } ] } })");
  EXPECT_EQ(far.origin.y(), 0);
  EXPECT_EQ(far.origin.z(), 0);
  EXPECT_NEAR(far.origin.x(), 431250.5, 0.5);
  const Json written = Json::parse(writeScene(far));
  EXPECT_EQ(written["boundary"]["surfaces"][0]["point"].dump(), "[0.1,0.1,0.3]");
  EXPECT_EQ(written["fluid"][0]["min"].dump(), "[431250.1,0.1,0.3]");
}

// [FM] 5: a bowl by formula has its own coordinates, which the transform moves.
TEST_F(FarScene, BowlsAreFittedWhereTheyAre) {
  const auto bowl = [&](const Vec3d& center, const Vec3d& translate) {
    return scene(R"({ "format": 1, "particle_spacing": 0.05, "boundary": { "surfaces": [
        { "shape": "slim", "fluid": "outside", "nodes": 500, "bowl": { "center": )" +
                 at(center) + R"(, "radius": 0.5, "thickness": 0.1 },
          "transform": { "translate": )" +
                 at(translate) + " } } ] } }");
  };
  const Vec3d here(0.25, 0.5, 0.125);
  const Scene near = bowl(here, {0, 0, 0}), byCenter = bowl(kFar + here, {0, 0, 0}),
              byMove = bowl(here, kFar);
  for (const Scene* far : {&byCenter, &byMove}) {
    EXPECT_LT((far->origin - kFar).norm(), 2);
    for (int k = 0; k < 20; ++k) {
      const Vec3d p = here + Vec3d(0.05 * k - 0.5, 0.02 * k - 0.4, 0.1 - 0.03 * k);
      Vec3f normal;
      const float there = far->surfaces[0]->distance((kFar - far->origin + p).cast<float>(), normal);
      EXPECT_NEAR(there, near.surfaces[0]->distance(p.cast<float>(), normal), 2e-3) << at(p);
    }
  }
}

// The tank of a user at 8.7 km, which was refused.
TEST_F(FarScene, TankAtFiveKilometresOnEachAxis) {
  const auto tank = [&](double x) {
    return scene(R"({ "format": 1, "particle_spacing": 0.05, "fluid": [ { "shape": "box", "min": )" +
                 at(Vec3d::Constant(x)) + R"(, "max": )" + at(Vec3d(0.5, 0.8125, 1) + Vec3d::Constant(x)) +
                 R"( } ], "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": )" +
                 at(Vec3d::Constant(x)) + R"(, "max": )" + at(Vec3d::Constant(x + 1)) + " } ] } }");
  };
  EXPECT_EQ(tank(5000).origin, Vec3d(5000, 5000, 5000));
  EXPECT_EQ(hashAfter(tank(5000), 50), hashAfter(tank(0), 50));
}

// Faults are found as anywhere, and numbers that are none do no harm.
TEST(SceneOrigin, FaultsFarFromZeroAreNamed) {
  const auto faultOf = [](const std::string& rest) {
    try {
      parseScene(R"({ "format": 1, "fluid": [ { "shape": "box", "min": [431250, 0, 0], "max": [)" + rest,
                 "far.json");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(faultOf("431249, 1, 1] } ] }"),
            "far.json:/fluid/0/max: expected every coordinate to be larger than that of min, found one that "
            "is not");
  EXPECT_EQ(faultOf("1e9, 1, 1] } ] }"),
            "far.json:/fluid/0/max/0: expected a number in [-1e+07, 1e+07] (unit: m), found 1000000000.0");
  EXPECT_EQ(faultOf("431251, 1, 1] } ], \"boundary\": [1] }"),
            "far.json:/boundary: expected an object, found an array of 1 entry");
  EXPECT_NE(
      faultOf("431251, 1, 1] }, 5 ], \"boundary\": { \"surfaces\": [ [], { \"shape\": \"mesh\", \"file\": "
              "\"none.obj\", \"transform\": { \"scale\": 1e300 } } ] } }"),
      "");
}

}  // namespace far_scene_test
}  // namespace migiwa
