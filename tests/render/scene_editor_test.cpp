// The scene's text in the window: typing, faults at their lines, Apply and Save as, with input made up.
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace scene_editor_test {

constexpr int kWidth = 1280, kHeight = 720;
namespace fs = std::filesystem;

class SceneEditorTest : public ::testing::Test {
 protected:
  ~SceneEditorTest() override { fs::remove_all(folder_); }

  fs::path writeScene() const {
    std::ofstream(folder_ / "small.json") << R"({
  "format": 1,
  "name": "Small",
  "particle_spacing": 0.1,
  "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.5, 0.6, 0.5] } ],
  "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5] } ] },
  "solver": { "time_step": 0.005, "max_iterations": 4 }
}
)";
    return folder_ / "small.json";
  }

  void frame(const InputState& input) {
    simulation_->takeFrame(frame_);
    const UiCommands commands = viewer_->frame(frame_.view(), simulation_->status(), input, kWidth, kHeight);
    keepState(commands, session_, *simulation_);
    applyRequest(editor_, session_, viewer_->settings(), viewer_->view());
  }
  void idle(int frames) {
    for (int k = 0; k < frames; ++k) frame(InputState{});
  }
  void click(float x, float y) {
    for (const bool pressed : {false, false, true, true, false, false}) {
      InputState input;
      input.mouseInside = true;
      input.mouseX = x, input.mouseY = y;
      input.buttons[0] = pressed;
      frame(input);
    }
  }
  void press(Key key) {
    InputState input;
    input.keys[static_cast<std::size_t>(key)] = true;
    frame(input);
    frame(InputState{});
  }
  void type(std::string_view text) {
    InputState input;
    for (const char c : text) input.characters.push_back(static_cast<unsigned char>(c));
    frame(input);
    frame(InputState{});
  }
  /// Opens the editor by its button, with the caret in the text.
  void open() {
    idle(2);
    click(80, 40);
    ASSERT_TRUE(editor_.open);
    idle(3);
  }
  /// One step of the simulation, and its frame.
  void step() {
    const double before = frame_.info.time;
    simulation_->step();
    for (int k = 0; k < 300000 && frame_.info.time <= before; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      simulation_->takeFrame(frame_);
    }
  }
  /// Waits until the status says so of the state's file.
  void awaitState(const std::string& note) {
    for (int k = 0; k < 300000 && simulation_->status().stateNote != note; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(simulation_->status().stateNote, note);
    idle(2);
  }
  /// Waits for what was asked for, and takes it over as the window's loop does.
  void settle() {
    std::optional<SceneChange> change;
    // A changed file is seen at the first look and believed at the second.
    for (int k = 0; k < 4 && !(change = session_.poll()); ++k) session_.wait();
    ASSERT_TRUE(change);
    tellEditor(*change, session_, editor_);
    if (change->scene) applyChange(*change, session_, *viewer_, simulation_);
    idle(2);
  }

  void writePicture(const std::string& name) const {
    fs::create_directories(MIGIWA_PICTURES);
    writeTextFile(fs::path(MIGIWA_PICTURES) / (name + ".png"), encodePng(viewer_->picture()));
  }

  const fs::path folder_ = freshFolder("editor");
  std::unique_ptr<GlContext> context_ = makeEglContext();
  Scene scene_ = readScene(writeScene());
  SceneSession session_{scene_, {{}, 1, Pace::unlimited}};
  std::unique_ptr<SimulationThread> simulation_ =
      std::make_unique<SimulationThread>(scene_, 1, Pace::unlimited);
  SceneEditor editor_ = makeEditor(session_);
  std::unique_ptr<Viewer> viewer_ =
      std::make_unique<Viewer>(simulation_->scene(), simulation_->walls(),
                               ViewerOptions{.scale = 1, .timings = false, .editor = &editor_});
  FrameSnapshot frame_;
};

TEST_F(SceneEditorTest, TypingChangesTheTextAndApplyTakesItOver) {
  open();
  editor_.goTo = 4;
  idle(2);
  EXPECT_EQ(editor_.caretLine, 4);
  press(Key::home);
  type("  \"duration\": 2.5,\n");
  EXPECT_NE(editor_.text.find("  \"duration\": 2.5,\n  \"particle_spacing\""), std::string::npos)
      << editor_.text;
  EXPECT_TRUE(editor_.edited());
  // A space has gone into the text, not to the simulation.
  EXPECT_FALSE(simulation_->status().playing);
  editor_.apply = true;
  idle(1);
  settle();
  EXPECT_TRUE(editor_.faults.empty());
  EXPECT_EQ(editor_.note, "taken over");
}

TEST_F(SceneEditorTest, AFaultIsMarkedListedAndFoundByAClick) {
  const std::string before = editor_.text;
  open();
  editor_.goTo = 7;
  idle(2);
  press(Key::home);
  type("  \"gravty\": 1,\n");
  editor_.apply = true;
  idle(1);
  settle();
  ASSERT_EQ(editor_.faults.size(), 1U);
  EXPECT_EQ(editor_.faults[0].line, 7);
  EXPECT_EQ(editor_.faults[0].message,
            "/gravty: expected a known key, found \"gravty\"; did you mean \"gravity\"?");
  EXPECT_EQ(simulation_->scene().name, "Small") << "the scene before it goes on";
  editor_.goTo = 1;
  editor_.wantsFocus = true;
  idle(3);
  EXPECT_EQ(editor_.caretLine, 1);

  const Image picture = viewer_->picture();
  writePicture("scene_editor");
  // The first entry of the list under the text: its colour is found there, and a click on it moves the caret.
  const auto alert = [&](int x, int y) {
    const auto pixel = picture.pixel(x, y);
    return pixel[0] > 200 && pixel[1] > 110 && pixel[1] < 170 && pixel[2] < 150;
  };
  int listed = 0;
  for (int y = kHeight - 1; y > kHeight / 2 && listed == 0; --y)
    for (int x = 720; x < 1000 && listed == 0; ++x)
      if (alert(x, y)) listed = y;
  ASSERT_GT(listed, 0);
  click(800, static_cast<float>(listed - 4));
  idle(2);
  EXPECT_EQ(editor_.caretLine, 7);

  editor_.revert = true;
  idle(1);
  settle();
  EXPECT_EQ(editor_.text, before);
  EXPECT_TRUE(editor_.faults.empty());
}

TEST_F(SceneEditorTest, GeometryBeginsAnewAndTheCameraStays) {
  open();
  viewer_->view().camera.eye = {4, 3, 2};
  std::string deeper = editor_.text;
  editor_.replaceText(deeper.replace(deeper.find("0.6"), 3, "0.8"));
  editor_.apply = true;
  idle(1);
  settle();
  EXPECT_EQ(editor_.note, "taken over from the start");
  idle(1);
  EXPECT_EQ(frame_.positions.size(), 5U * 8U * 5U);
  EXPECT_EQ(viewer_->view().camera.eye, Vec3d(4, 3, 2));
}

TEST_F(SceneEditorTest, EffectsTakenOverRunFromTheNextFrame) {
  const auto runs = [&](const std::string& effect) {
    const auto stages = frame_.info.stages.stages();
    return std::ranges::count(stages, effect, &StageTime::name) == 1;
  };
  open();
  for (int k = 0; k < 3; ++k) step();
  ASSERT_FALSE(runs("vorticity_confinement"));
  const std::size_t stages = frame_.info.stages.stages().size();
  const std::string before = editor_.text;
  std::string text = before;
  editor_.replaceText(text.insert(text.find('{') + 1, R"("effects": { "vorticity_confinement": {} },)"));
  editor_.apply = true;
  idle(1);
  settle();
  EXPECT_EQ(editor_.note, "taken over");
  step();
  EXPECT_NEAR(frame_.info.time, 0.02, 1e-9) << "goes on";
  EXPECT_TRUE(runs("vorticity_confinement"));
  EXPECT_EQ(frame_.info.stages.stages().size(), stages + 1);
  idle(2);
  writePicture("effect_added");

  editor_.replaceText(before);
  editor_.apply = true;
  idle(1);
  settle();
  step();
  EXPECT_NEAR(frame_.info.time, 0.025, 1e-9);
  EXPECT_FALSE(runs("vorticity_confinement"));
  EXPECT_EQ(frame_.info.stages.stages().size(), stages);
}

/// What was undone would be places in the text of before.
TEST_F(SceneEditorTest, NothingOfATextIsUndoneInAnother) {
  open();
  for (int k = 0; k < 6; ++k) {
    press(Key::end);
    type("  a word ");
    press(Key::down);
  }
  const std::string other = "{ \"format\": 1 }";
  editor_.replaceText(other);
  idle(3);
  EXPECT_EQ(editor_.text, other);
  for (const Key key : {Key::z, Key::z, Key::z, Key::z, Key::y, Key::y, Key::z}) {
    InputState input;
    input.control = true;
    input.keys[static_cast<std::size_t>(key)] = true;
    frame(input);
    idle(1);
    ASSERT_EQ(editor_.text, other);
  }
  type("b");
  EXPECT_EQ(editor_.text.size(), other.size() + 1) << "the keyboard is still the text's";
}

TEST_F(SceneEditorTest, SaveAsKeepsCameraAndSettings) {
  open();
  viewer_->view().camera.eye = {4, 3, 2};
  editor_.saveName = "turned";
  editor_.save = true;
  idle(1);
  EXPECT_EQ(editor_.note, "saving ...");
  settle();
  EXPECT_EQ(editor_.fileName, "turned.json");
  EXPECT_EQ(editor_.saveName, "turned.json");
  EXPECT_EQ(editor_.note, "saved as " + (folder_ / "turned.json").string() + ", taken over");
  const Scene saved = readScene(folder_ / "turned.json");
  EXPECT_EQ(saved.view.camera.eye, Vec3d(4, 3, 2));
  EXPECT_EQ(editor_.text, session_.fileText());
  EXPECT_FALSE(editor_.edited());
  editor_.saveName = "a/b";
  editor_.save = true;
  idle(1);
  settle();
  EXPECT_EQ(editor_.faults.size(), 1U);
  EXPECT_EQ(editor_.note, "not saved: 1 fault");
}

TEST_F(SceneEditorTest, WhatIsTypedWhileAFileIsSavedStays) {
  editor_.saveName = "first";
  editor_.save = true;
  idle(1);
  editor_.text += "\n";
  editor_.saveName = "second";
  settle();
  EXPECT_EQ(editor_.fileName, "first.json");
  EXPECT_EQ(editor_.saveName, "second");
  EXPECT_EQ(editor_.known, session_.fileText());
  EXPECT_TRUE(editor_.edited());
}

TEST_F(SceneEditorTest, NoStateIsSavedOrLoadedWhileTheRunIsHeld) {
  constexpr float kSave = 80, kLoad = 230, kRow = 123;
  idle(2);
  simulation_->hold("a test");
  click(kSave, kRow);
  click(kLoad, kRow);
  EXPECT_EQ(simulation_->status().refused, "") << "the buttons cannot be pressed";
  simulation_->release();
  idle(1);
  click(kSave, kRow);
  awaitState("Saved at 0.000 s: small.save");
}

TEST_F(SceneEditorTest, StateIsSavedAndLoadedByItsButtons) {
  constexpr float kSave = 80, kLoad = 230, kRow = 123;
  idle(2);
  for (int k = 0; k < 6; ++k) step();
  click(kSave, kRow);
  awaitState("Saved at 0.030 s: small.save");
  const std::uint64_t saved = frame_.info.stateHash;
  writePicture("state_saved");
  for (int k = 0; k < 6; ++k) step();
  const std::uint64_t later = frame_.info.stateHash;
  click(kLoad, kRow);
  awaitState("Loaded at 0.030 s: small.save");
  EXPECT_EQ(frame_.info.stateHash, saved);
  for (int k = 0; k < 6; ++k) step();
  EXPECT_EQ(frame_.info.stateHash, later);

  // What is no save of this scene is told where the button is.
  std::ofstream(folder_ / "small.save") << "nothing of the kind";
  click(kLoad, kRow);
  awaitState("Not loaded, the simulation goes on:");
  writePicture("state_refused");
  EXPECT_EQ(frame_.info.stateHash, later);
  fs::remove(folder_ / "small.save");
  fs::create_directory(folder_ / "small.save");
  click(kSave, kRow);
  awaitState("Not saved:");
}

TEST_F(SceneEditorTest, AFileThatBreaksLeavesAnEditedTextAlone) {
  open();
  editor_.replaceText(editor_.text + "\n");
  std::ofstream(folder_ / "small.json") << "{ \"format\": 1\n  \"name\": 2 }";
  EXPECT_FALSE(session_.poll()) << "may still be written";
  settle();
  ASSERT_EQ(editor_.faults.size(), 1U);
  EXPECT_EQ(editor_.faults[0].line, 2);
  EXPECT_EQ(editor_.text.back(), '\n');
  EXPECT_NE(editor_.text.find("Small"), std::string::npos);
  EXPECT_EQ(editor_.note, "small.json has changed: 1 fault, the scene before it goes on");
}

}  // namespace scene_editor_test
}  // namespace migiwa
