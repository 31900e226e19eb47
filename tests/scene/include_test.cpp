// A scene that includes another: what is merged, and where faults are said to be.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {
namespace include_test {

namespace fs = std::filesystem;

constexpr std::string_view kBase = R"({ "format": 1, "name": "Base", "duration": 4, "particle_spacing": 0.1,
  "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5] },
             { "shape": "sphere", "center": [2, 1, 1], "radius": 0.3 } ],
  "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [3, 2, 2] } ] },
  "solver": { "tolerance": 0.02, "max_iterations": 7 },
  "effects": { "viscosity": { "xsph": 0.3 } },
  "view": { "clip": { "axis": "x", "at": 1 } } })";

class Include : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("migiwa_include_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("base.json", kBase);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const fs::path& name, std::string_view text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  Scene read(const fs::path& name, const std::vector<Override>& overrides = {}) const {
    return readScene(folder_ / name, overrides);
  }
  Scene variant(std::string_view text) const {
    write("variant.json", text);
    return read("variant.json");
  }
  /// The faults with the names of the files relative to the folder.
  std::string faults(const fs::path& name, const std::vector<Override>& overrides = {}) const {
    try {
      read(name, overrides);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return "";
  }
  std::string faultsOf(std::string_view text) const {
    write("variant.json", text);
    return faults("variant.json");
  }

  fs::path folder_;
};

TEST_F(Include, AloneIsTheIncludedSceneUnderItsOwnFile) {
  const Scene scene = variant(R"({ "include": "base.json" })");
  EXPECT_EQ(writeScene(scene), writeScene(read("base.json")));
  EXPECT_EQ(scene.file, folder_ / "variant.json");
}

TEST_F(Include, ObjectsMergeByKeyListsAndValuesReplace) {
  const Scene scene = variant(R"({ "include": "base.json", "name": "Variant",
      "solver": { "max_iterations": 9 }, "view": { "color": "speed" },
      "fluid": [ { "shape": "sphere", "center": [1, 1, 1], "radius": 0.4 } ] })");
  EXPECT_EQ(scene.name, "Variant");
  EXPECT_EQ(scene.solver.maxIterations, 9);
  EXPECT_EQ(scene.solver.tolerance, 0.02);
  EXPECT_TRUE(scene.view.clip.enabled);
  EXPECT_EQ(scene.view.color, ColorField::speed);
  ASSERT_EQ(scene.fluid.size(), 1U);
  EXPECT_EQ(scene.fluid[0]->bounds().max, Vec3d(1.4, 1.4, 1.4));
  EXPECT_EQ(scene.surfaces.size(), 1U);
}

TEST_F(Include, NullTakesAKeyOut) {
  const Scene scene =
      variant(R"({ "include": "base.json", "effects": { "viscosity": null }, "view": null })");
  EXPECT_TRUE(scene.effects.empty());
  EXPECT_FALSE(scene.view.clip.enabled);
}

TEST_F(Include, SetReachesIntoListsAndComesLast) {
  const Scene scene = variant(R"({ "include": "base.json", "duration": 2,
      "set": { "/fluid/1/radius": 0.2, "/duration": 3, "/effects/viscosity": null,
               "/boundary/surfaces/-": { "shape": "plane", "point": [0, 0.1, 0], "normal": [0, 1, 0] } } })");
  EXPECT_EQ(scene.fluid.at(1)->bounds().max, Vec3d(2.2, 1.2, 1.2));
  EXPECT_EQ(scene.duration, 3);
  EXPECT_EQ(scene.surfaces.size(), 2U);
  EXPECT_TRUE(scene.effects.empty());
}

TEST_F(Include, ChainsAndOptionsGoOverAll) {
  write("middle/one.json",
        R"({ "include": "../base.json", "solver": { "max_iterations": 8 }, "duration": 5 })");
  write("two.json", R"({ "include": "middle/one.json", "duration": 6, "set": { "/fluid/0/max/1": 0.4 } })");
  const Scene scene = read("two.json", {Override::parse("/fluid/0/max/0=0.3")});
  EXPECT_EQ(scene.duration, 6);
  EXPECT_EQ(scene.solver.maxIterations, 8);
  EXPECT_EQ(scene.solver.tolerance, 0.02);
  EXPECT_EQ(scene.fluid.at(0)->bounds().max, Vec3d(0.3, 0.4, 0.5));
  const auto files = filesOfScene(folder_ / "two.json");
  ASSERT_EQ(files.size(), 3U);
  EXPECT_TRUE(fs::equivalent(files[1], folder_ / "middle/one.json"));
  EXPECT_TRUE(fs::equivalent(files[2], folder_ / "base.json"));
}

TEST_F(Include, FilesAreRelativeToTheSceneThatNamesThem) {
  write("meshes/tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write("meshes/scene.json", R"({ "format": 1, "particle_spacing": 0.1,
      "fluid": [ { "shape": "mesh", "file": "tetrahedron.obj" } ] })");
  const Scene scene = variant(R"({ "include": "meshes/scene.json" })");
  EXPECT_EQ(scene.fluid.at(0)->bounds().max, Vec3d(1, 1, 1));
  // Written beside the variant, the name leads to the same file.
  const std::string text = writeScene(scene);
  EXPECT_NE(text.find("\"meshes/tetrahedron.obj\""), std::string::npos) << text;
  EXPECT_EQ(writeScene(variant(text)), text);
}

TEST_F(Include, NormalisedSceneRunsToTheSameHash) {
  const Scene scene = variant(R"({ "include": "base.json", "solver": { "time_step": 0.01 },
      "set": { "/fluid/1/velocity": [0, -1, 0] } })");
  const auto hashAfter = [](const Scene& run) {
    Simulation simulation(run, 1);
    for (int k = 0; k < 5; ++k) simulation.advanceFrame();
    return simulation.stateHash();
  };
  const std::uint64_t hash = hashAfter(scene);
  EXPECT_EQ(hashAfter(parseScene(writeScene(scene), folder_ / "variant.json")), hash);
  EXPECT_NE(hashAfter(read("base.json")), hash);
}

TEST_F(Include, FaultsAreWhereTheValueWasWritten) {
  write("faulty.json",
        R"({ "format": 1, "duration": -1, "gravity": [0, 1], "solver": { "cfl": -1, "tolerance": 3 },
      "fluid": [ { "shape": "sphere", "center": [0, 0, 0] } ], "view": { "clip": { "axis": "x", "at": 0 } } })");
  write("variant.json", R"({ "include": "faulty.json", "duration": -2, "solver": { "tolerance": 2 },
      "effects": { "viscosity": { "xspf": 1 } },
      "view": { "clip": { "at": null } },
      "set": { "/solver/substeps": 0, "/solver/kernl": "poly6", "/fluid/0/shap": 1, "/fluid/-": { "shape": "sphere", "center": [1, 1, 1], "radius": -3 } } })");
  EXPECT_EQ(
      faults("variant.json", {Override::parse("/solver/cfm_epsilon=-1")}),
      "variant.json:/duration: expected a number in (0, 1e+06] (unit: s), found -2\n"
      "faulty.json:/gravity: expected an array of 3 numbers (unit: m/s^2), found an array of 2 entries\n"
      "faulty.json:/fluid/0/radius: expected a number in [1e-09, 1e+07] (unit: m), found nothing; the key is "
      "required\n"
      "variant.json:/set/~1fluid~10~1shap: expected a known key, found \"shap\"; did you mean \"shape\"? "
      "(/fluid/0/shap)\n"
      "variant.json:/set/~1fluid~1-/radius: expected a number in [1e-09, 1e+07] (unit: m), found -3 "
      "(/fluid/1/radius)\n"
      "variant.json:/set/~1solver~1substeps: expected a whole number in [1, 1000], found 0 "
      "(/solver/substeps)\n"
      "faulty.json:/solver/cfl: expected a number in [0, 10], found -1\n"
      "variant.json:/solver/tolerance: expected a number in [0, 1), found 2\n"
      "--set /solver/cfm_epsilon: expected a number in [1e-09, 1e+06], found -1\n"
      "variant.json:/set/~1solver~1kernl: expected a known key, found \"kernl\"; did you mean \"kernel\"? "
      "(/solver/kernl)\n"
      "variant.json:/effects/viscosity/xspf: expected a known key, found \"xspf\"; did you mean \"xsph\"?\n"
      "variant.json:/view/clip/at: expected a number in [-1e+07, 1e+07] (unit: m), found nothing; the key is "
      "required");
}

TEST_F(Include, WhatSetMakesOnItsWayIsThere) {
  EXPECT_EQ(faultsOf(R"({ "include": "base.json", "view": null, "set": { "/view/clip/axis": "y" } })"),
            "variant.json:/set/~1view~1clip~1axis: expected a number in [-1e+07, 1e+07] (unit: m), found "
            "nothing; the key is required (/view/clip/at)");
  EXPECT_EQ(faults("base.json", {Override::parse("/view/camera/up=[0, 1, 0]")}),
            "--set /view/camera/eye: expected an array of 3 numbers (unit: m), found nothing; the key is "
            "required\n"
            "--set /view/camera/target: expected an array of 3 numbers (unit: m), found nothing; the key is "
            "required");
}

TEST_F(Include, CyclesAreNamed) {
  write("a.json", R"({ "include": "b.json" })");
  write("b.json", R"({ "include": "./sub/../a.json" })");
  write("self.json", R"({ "include": "self.json" })");
  write("in.json", R"({ "include": "a.json" })");
  const auto expectCycle = [&](const char* file, const char* place, const std::string& cycle) {
    EXPECT_EQ(faults(file),
              std::string(place) +
                  "/include: expected a scene that does not include itself, found a cycle: " + cycle);
    EXPECT_LE(filesOfScene(folder_ / file).size(), 3U);
  };
  expectCycle("self.json", "self.json:", "self.json includes self.json");
  expectCycle("a.json", "b.json:", "a.json includes b.json, which includes a.json");
  expectCycle("in.json", "b.json:", "a.json includes b.json, which includes a.json");
}

TEST_F(Include, WhatCannotBeReadIsSaidWhereItIsNamed) {
  EXPECT_EQ(faultsOf(R"({ "include": "none.json" })"),
            "variant.json:/include: expected a scene file, found no such file (none.json)");
  EXPECT_EQ(faultsOf(R"({ "include": 3 })"),
            "variant.json:/include: expected the name of a scene file, found 3");
  EXPECT_EQ(faultsOf(R"({ "include": "" })"),
            "variant.json:/include: expected the name of a scene file, found \"\"");
  write("broken.json", "{ \"format\": 1,\n");
  EXPECT_EQ(faultsOf(R"({ "include": "broken.json" })"),
            "broken.json:2:1: expected a key in double quotes, found the end of the text");
  write("list.json", "[]");
  EXPECT_EQ(faultsOf(R"({ "include": "list.json" })"),
            "list.json:/: expected an object, found an empty array");
}

TEST_F(Include, SetIsChecked) {
  EXPECT_EQ(faultsOf(R"({ "include": "base.json", "set": [] })"),
            "variant.json:/set: expected an object of JSON pointers and values, found an empty array");
  EXPECT_EQ(
      faultsOf(R"({ "include": "base.json", "set": { "duration": 1, "/fluid/7/trim": true,
                           "/include": "x", "/a~": 1 } })"),
      "variant.json:/set/duration: expected a JSON pointer such as \"/fluid/0/max\", found \"duration\"\n"
      "variant.json:/set/~1fluid~17~1trim: expected the index of one of 2 entries at /fluid, found \"7\"\n"
      "variant.json:/set/~1include: expected a key of the scene, found one that is only read in a file "
      "itself\n"
      "variant.json:/set/~1a~0: expected a JSON pointer such as \"/fluid/0/max\", found \"/a~\"");
}

}  // namespace include_test
}  // namespace migiwa
