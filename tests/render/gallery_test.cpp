// What `migiwa view` can open: every shipped scene with a picture, the last ones, and scenes around shapes.
#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/commands/command.h"
#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "core/base/messages.h"
#include "core/simulation/simulation.h"
#include "tests/render/shown_text.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace gallery_test {

namespace fs = std::filesystem;

class Gallery : public ::testing::Test {
 protected:
  Gallery() {
    setenv("MIGIWA_CACHE", (folder_ / "cache").c_str(), 1);
    std::ofstream(mesh_) << "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 2 0 1\nv 2 1 1\nv 0 1 1\n"
                            "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  }
  ~Gallery() override {
    if (before_.empty())
      unsetenv("MIGIWA_CACHE");
    else
      setenv("MIGIWA_CACHE", before_.c_str(), 1);
    fs::remove_all(folder_);
  }
  fs::path sceneFile(const std::string& name) {
    const fs::path file = folder_ / (name + ".json");
    std::ofstream(file) << R"({"format": 1, "name": ")" << name << R"(", "particle_spacing": 0.1})";
    return file;
  }
  static std::vector<std::string> recent() {
    std::vector<std::string> names;
    for (const GalleryEntry& entry : galleryEntries())
      if (entry.recent) names.push_back(entry.name);
    return names;
  }
  /// Water falls on what was opened, and none of it is inside.
  static void expectToRun(const Scene& scene) {
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    Simulation simulation(scene, 1);
    ASSERT_GT(simulation.view().positions.size(), 300U);
    for (int k = 0; k < 60; ++k) simulation.advanceFrame();
    EXPECT_FALSE(simulation.stopped());
    float lowest = 1e9F;
    for (const Float4& position : simulation.view().positions) lowest = std::min(lowest, position.y);
    const Vec3d low = scene.bounds().min;
    EXPECT_GT(static_cast<double>(lowest), low.y());
  }

  const std::string before_ = std::getenv("MIGIWA_CACHE") != nullptr ? std::getenv("MIGIWA_CACHE") : "";
  const fs::path folder_ = freshFolder("gallery");
  const fs::path mesh_ = folder_ / "block.obj";
};

TEST_F(Gallery, HasEveryShippedSceneWithAPictureAndWords) {
  const std::vector<GalleryEntry> entries = galleryEntries();
  std::size_t scenes = 0;
  for (const auto& file : fs::directory_iterator(MIGIWA_SOURCE_DIR "/scenes"))
    scenes += file.path().extension() == ".json" && file.path().stem() != "scene.schema" ? 1U : 0U;
  ASSERT_EQ(entries.size(), scenes);
  std::uintmax_t bytes = 0;
  for (const GalleryEntry& entry : entries) {
    EXPECT_FALSE(entry.name.empty()) << entry.file;
    EXPECT_GT(entry.description.size(), 40U) << entry.file;
    ASSERT_FALSE(entry.picture.empty()) << entry.file << ": ./run screenshots thumbnails";
    const std::optional<Image> picture = readPng(entry.picture);
    ASSERT_TRUE(picture) << entry.picture;
    EXPECT_EQ(picture->width * 9, picture->height * 16) << entry.picture;
    bytes += fs::file_size(entry.picture);
  }
  EXPECT_LT(bytes, 1'000'000U);
}

TEST_F(Gallery, RemembersTheLastOnesEachOnce) {
  for (const char* name : {"a", "b", "c", "a", "d", "e", "f", "g", "h"}) openScene(sceneFile(name), {});
  EXPECT_EQ(recent(), (std::vector<std::string>{"h", "g", "f", "e", "d", "a"}));
  fs::remove(folder_ / "g.json");
  EXPECT_EQ(recent(), (std::vector<std::string>{"h", "f", "e", "d", "a"}));
  std::ofstream(folder_ / "faulty.json") << R"({"format": 1, "particle_spacing": -1})";
  EXPECT_THROW(openScene(folder_ / "faulty.json", {}), InputError);
  EXPECT_THROW(openScene(folder_ / "none.json", {}), InputError);
  EXPECT_EQ(recent().front(), "h") << "what could not be opened is not remembered";
}

TEST_F(Gallery, AMeshBecomesASceneInWhichWaterFallsOnIt) {
  const Scene scene = openScene(mesh_, {});
  EXPECT_EQ(scene.name, "block.obj");
  expectToRun(scene);
  EXPECT_EQ(recent(), std::vector<std::string>{"block.obj"});
}

TEST_F(Gallery, ASlimFileDoes) {
  ASSERT_EQ(runCommandLine({"slim", mesh_.string(), "--out", (folder_ / "slim.json").string(), "--nodes",
                            "300", "--quiet"}),
            kDone);
  expectToRun(openScene(folder_ / "slim.json", {}));
}

TEST_F(Gallery, WhatIsNoShapeIsRefusedWithTheReason) {
  std::ofstream(folder_ / "text.obj") << "hello\n";
  EXPECT_THROW(openScene(folder_ / "text.obj", {}), InputError);
  EXPECT_THROW(openScene(folder_ / "none.stl", {}), InputError);
}

TEST_F(Gallery, ShowsCardsAndOpensTheOneThatIsClicked) {
  const auto context = makeEglContext();
  Simulation simulation(smallScene(), 1);
  GalleryModel model;
  model.entries = galleryEntries();
  model.open = true;
  model.faults = {"no such file"};
  SceneEditor editor;
  Viewer viewer(simulation.scene(), simulation.walls(), {.scale = 1, .editor = &editor, .gallery = &model});
  const auto frame = [&](bool pressed) {
    InputState input;
    input.mouseInside = true;
    input.mouseX = 450, input.mouseY = 220;
    input.buttons[0] = pressed;
    viewer.frame(simulation.view(), RunStatus{}, input, 1280, 720);
  };
  for (const bool pressed : {false, false, true, true, false, false}) frame(pressed);
  ASSERT_TRUE(model.ask);
  EXPECT_EQ(*model.ask, model.entries.front().file);
  EXPECT_NE(model.entries.front().texture, 0U);
  const std::string text = shownText();
  for (const char* word : {"Shipped", "no such file", "bowl", "Open"})
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

}  // namespace gallery_test
}  // namespace migiwa
