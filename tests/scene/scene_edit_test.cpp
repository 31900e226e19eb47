// Lines of faults in a text, and changes written back into it.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {
namespace scene_edit_test {

constexpr std::string_view kText = R"({
  "format": 1,
  "duration": -1,
  "name": "a \" } ] , b",
  "fluid": [
    { "shape": "sphere", "center": [0, 0, 0],
      "radius": 0 },
    { "shape": "box",
      "min": [0,
        "low", 0], "max": [1, 1, 1], "sizes": {} }
  ],
  "solver": { "cfl": -1,
    "tolerence": 0.1 },
  "view": {}
}
)";

std::vector<int> linesOf(std::string_view text) {
  std::vector<int> lines;
  try {
    parseScene(text, "some/scene.json", {Override::parse("/solver/substeps=0")});
  } catch (const InputError& error) {
    lines = linesOfFaults(error.faults(), text, "some/scene.json");
  }
  return lines;
}

TEST(SceneEdit, FaultsHaveLines) {
  // In the order of the keys: duration, radius, "low", sizes, --set, cfl, tolerence.
  EXPECT_EQ(linesOf(kText), (std::vector<int>{3, 7, 10, 10, 0, 12, 13}));
  EXPECT_EQ(linesOf("{\n\n  \"format\" 1 }"), std::vector<int>{3});
  EXPECT_EQ(linesOf("\n[]\n"), std::vector<int>{2});
  // What is missing is at the object that lacks it.
  EXPECT_EQ(linesOf("{ \"format\": 1, \"fluid\": [\n\n{ \"shape\": \"sphere\",\n \"radius\": 1 } ] }"),
            (std::vector<int>{3, 0}));
}

TEST(SceneEdit, PointersAreFollowedThroughTheText) {
  const Fault fault{"s.json:/a~1b/1/c", ""};
  EXPECT_EQ(
      linesOfFaults({&fault, 1}, "{\n\"a\": 1,\n\"a/b\": [ [\n], {\n\"x\": 1,\n\"c\": 2 } ] }", "s.json")
          .front(),
      6);
  const Fault elsewhere{"other.json:/a", ""};
  EXPECT_EQ(linesOfFaults({&elsewhere, 1}, "{}", "s.json").front(), 0);
}

constexpr std::string_view kScene = R"({ "format": 1, "particle_spacing": 0.1, "gravity": [0, -9.81, 0],
  "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5], "velocity": [1, 0, 0] } ],
  "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5] } ] },
  "solver": { "time_step": 0.01 } })";

TEST(SceneEdit, WhatHasNotChangedStaysAsItIsWritten) {
  EXPECT_EQ(sceneTextWith(kScene, "s.json", parseScene(kScene, "s.json")), kScene);
}

TEST(SceneEdit, OnlyWhatHasChangedIsWritten) {
  Scene scene = parseScene(kScene, "s.json");
  scene.solver.maxIterations = 3;
  scene.view.camera.eye = {1, 2, 3};
  scene.view.clip = {true, Axis::y, 0.25};
  const std::string text = sceneTextWith(kScene, "s.json", scene);
  EXPECT_EQ(text.find("tolerance"), std::string::npos) << text;
  EXPECT_EQ(text.find("\"color\""), std::string::npos) << text;
  EXPECT_EQ(writeScene(parseScene(text, "s.json")), writeScene(scene));
}

std::uint64_t hashAfter(const Scene& scene) {
  Simulation simulation(scene, 1);
  for (int k = 0; k < 6; ++k) simulation.advanceFrame();
  return simulation.stateHash();
}

TEST(SceneEdit, ChangedTextReadsBackToTheSameHash) {
  const std::vector<Override> overrides{Override::parse("/fluid/0/max/1=0.4"),
                                        Override::parse("/gravity/0=1")};
  Scene scene = parseScene(kScene, "s.json", overrides);
  scene.boundary.handling = BoundaryHandling::none;
  scene.solver.tolerance = 0.002;
  const std::string text = sceneTextWith(kScene, "s.json", scene);
  EXPECT_EQ(hashAfter(parseScene(text, "s.json")), hashAfter(scene));
  EXPECT_NE(hashAfter(parseScene(kScene, "s.json")), hashAfter(scene));
}

TEST(SceneEdit, VariantsStayVariantsUnlessSetStandsInTheWay) {
  const std::filesystem::path name = MIGIWA_SOURCE_DIR "/scenes/variant_that_is_not_there.json";
  const std::string variant = R"({ "include": "dam_break.json", "effects": { "viscosity": null },
                                   "set": { "/fluid/0/max/0": 0.6, "/solver/cfl": 0.3 } })";
  Scene scene = parseScene(variant, name);
  scene.solver.maxIterations = 3;
  const std::string kept = sceneTextWith(variant, name, scene);
  EXPECT_NE(kept.find("include"), std::string::npos);
  EXPECT_EQ(writeScene(parseScene(kept, name)), writeScene(scene));
  scene.solver.cfl = 0.2;
  const std::string whole = sceneTextWith(variant, name, scene);
  EXPECT_EQ(writeScene(parseScene(whole, name)), writeScene(scene));
}

TEST(SceneEdit, StartIsOfWhatOnlyANewBeginningCanChange) {
  const std::string start = startOf(parseScene(kScene, "s.json"));
  const auto with = [](const char* change) {
    return startOf(parseScene(kScene, "s.json", {Override::parse(change)}));
  };
  for (const char* change : {"/solver/tolerance=0.5", "/boundary/handling=none", "/view/color=speed",
                             "/name=other", "/duration=1", "/boundary/gamma/method=mean"})
    EXPECT_EQ(with(change), start) << change;
  for (const char* change : {"/fluid/0/max/0=0.4", "/boundary/surfaces/0/max/0=2", "/particle_spacing=0.09",
                             "/gravity/1=0", "/fluid/0/velocity/0=2"})
    EXPECT_NE(with(change), start) << change;
}

}  // namespace scene_edit_test
}  // namespace migiwa
