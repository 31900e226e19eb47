// Every scene of scenes/ at its start, with and without panels, and half a second later, against the pictures
// in tests/golden. Water that has moved is the same water on every machine, so its pictures are compared as
// strictly as those of the start. With --update-golden the program writes them anew instead.
#include "tests/render/golden.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/render/image_compare.h"

namespace migiwa {
namespace golden_test {

namespace fs = std::filesystem;

constexpr int kWidth = 400, kHeight = 225;
constexpr double kScale = 0.5;  // of text and panels, so that the scene is seen beside them

std::vector<fs::path> sceneFiles() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(MIGIWA_SOURCE_DIR) / "scenes")) {
    const fs::path& file = entry.path();
    // The format's schema lies beside the scenes.
    if (file.extension() == ".json" && file.stem().extension() != ".schema") files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

Image picture(const Simulation& simulation, const Scene& scene, bool panels,
              const ColorMap& colors = makeColorMap()) {
  Viewer viewer(scene, simulation.walls(), {kScale, panels, false, "", colors});
  return viewer.takePicture(simulation.drawnView(), RunStatus{}, kWidth, kHeight);
}

/// Compares with the golden picture of that name, or writes it. What differs is kept for looking at.
void compare(const Image& found, const std::string& name) {
  const fs::path golden = fs::path(MIGIWA_SOURCE_DIR) / "tests" / "golden" / (name + ".png");
  if (updateGolden) {
    fs::create_directories(golden.parent_path());
    writeTextFile(golden, encodePng(found));
    return;
  }
  const std::optional<Image> expected = readPng(golden);
  ASSERT_TRUE(expected) << golden << " is missing; ./run golden draws it";
  const double share = differentShare(*expected, found);
  if (share <= kAllowedShare) return;
  const fs::path folder = fs::path(MIGIWA_PICTURES) / "golden";
  fs::create_directories(folder);
  writeTextFile(folder / (name + "_found.png"), encodePng(found));
  writeTextFile(folder / (name + "_difference.png"), encodePng(differencePicture(*expected, found)));
  ADD_FAILURE() << name << ": " << 100 * share << "% of the pixels differ, expected at most "
                << 100 * kAllowedShare << "%; see " << (folder / (name + "_difference.png"));
}

class GoldenTest : public ::testing::TestWithParam<fs::path> {};

TEST_P(GoldenTest, LooksAsItDidAtTheStart) {
  const auto context = makeEglContext();
  const Simulation simulation(readScene(GetParam()));
  const std::string name = simulation.scene().stem() + "_t0.000";
  compare(picture(simulation, simulation.scene(), false), name);
  compare(picture(simulation, simulation.scene(), true), name + "_ui");
}

TEST_P(GoldenTest, LooksAsItDidWhenItHadMoved) {
  const auto context = makeEglContext();
  Simulation simulation(readScene(GetParam()));
  const long frame = simulation.frameAt(0.5);
  while (simulation.frame() < frame && !simulation.stopped()) simulation.advanceFrame();
  compare(picture(simulation, simulation.scene(), false), simulation.scene().stem() + "_t0.500");
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenTest, ::testing::ValuesIn(sceneFiles()),
                         [](const auto& scene) { return scene.param.stem().string(); });

class GoldenComparison : public ::testing::Test {
 protected:
  std::unique_ptr<GlContext> context_ = makeEglContext();
  Simulation simulation_{readScene(fs::path(MIGIWA_SOURCE_DIR) / "scenes" / "dam_break.json")};
  Image reference_ = picture(simulation_, simulation_.scene(), false);
};

TEST_F(GoldenComparison, AcceptsTheSamePicture) {
  EXPECT_EQ(differentShare(reference_, picture(simulation_, simulation_.scene(), false)), 0);
}

TEST_F(GoldenComparison, RefusesAShiftedColorMap) {
  ColorMap shifted = makeColorMap();
  std::rotate(shifted.begin(), shifted.begin() + 24, shifted.end());
  const Image found = picture(simulation_, simulation_.scene(), false, shifted);
  EXPECT_GT(differentShare(reference_, found), kAllowedShare);
}

TEST_F(GoldenComparison, RefusesAMovedCamera) {
  Scene moved = simulation_.scene();
  moved.view.camera.eye.x() += 0.02;
  moved.view.camera.target.x() += 0.02;
  EXPECT_GT(differentShare(reference_, picture(simulation_, moved, false)), kAllowedShare);
}

TEST_F(GoldenComparison, RefusesAnotherSize) {
  EXPECT_EQ(differentShare(reference_, Image(kWidth, kHeight + 1)), 1);
}

}  // namespace golden_test
}  // namespace migiwa
