// Undo and redo of what a person changes in the window: whatever a control does, taken back all is as before.
#include "app/session/undo.h"

#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "tests/render/hands.h"
#include "tests/render/test_scene.h"
#include "tests/support/test_effects.h"

namespace migiwa {
namespace undo_test {

constexpr int kWidth = 660, kHeight = 1150;  // high enough for every panel to be open

Scene sceneWithEffects() {
  Scene scene = smallScene();
  scene.effects = testing::effectsOf(R"({"viscosity": {}, "wall_friction": {}})");
  return scene;
}

class UndoWindow : public ::testing::Test {
 protected:
  UndoWindow() { hands_.look(4); }
  UiCommands frame(const InputState& input) {
    return viewer_.frame(frame_.view(), RunStatus{}, input, kWidth, kHeight);
  }
  Undoable now() { return {viewer_.settings(), viewer_.view(), "", ""}; }
  std::vector<std::string> done() { return viewer_.changes().done(); }
  /// So long without input that a turn of the wheel has ended.
  void rest() {
    InputState input;
    input.seconds = 1;
    for (int k = 0; k < 2; ++k) frame(input);
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  FrameSnapshot frame_ = frameOf({Vec3f(0.5F, 0.4F, 0.25F)}, 0.1F);
  SectionModel section_;
  InspectModel inspect_;
  Viewer viewer_{sceneWithEffects(), {}, {.scale = 1, .inspect = &inspect_, .section = &section_}};
  testing::Hands hands_{[this](const InputState& input) { return frame(input); }};
};

TEST_F(UndoWindow, WhatEachControlDoesIsTakenBackAndDoneAgain) {
  struct Control {
    std::string name;  ///< of the change that it makes, to begin with
    std::function<void()> use;
  };
  const auto click = [&](const char* words, float beside = 0) {
    return [this, words, beside] { hands_.clickOn(words, beside); };
  };
  const auto choose = [&](const char* words, const char* entry, float beside = 110) {
    return [this, words, entry, beside] { hands_.choose(words, entry, beside); };
  };
  const std::vector<Control> controls{
      {"/boundary/gamma/method=", choose("Method of ?", "nearest")},  // the letter is Greek
      {"/boundary/handling=", choose("Walls", "none")},
      {"/solver/min_iterations=", click("Min iterations", 150)},
      {"/solver/max_iterations=", click("Max iterations", 200)},
      {"/solver/tolerance=", click("Tolerance", 100)},
      {"/solver/position_step=", choose("Position step", "paper")},
      {"/solver/velocity_step=", choose("Velocities", "projection")},
      {"/solver/time_step=", click("Time step", 150)},
      {"/effects/viscosity/xsph=", click("Xsph", 200)},
      {"/effects/wall_friction/coefficient=", click("Coefficient", 150)},
      {"colour: gamma", choose("Colour", "gamma")},
      {"water on", click("Water")},
      {"cut on", click("Cut", 113)},
      {"cut at 0.5 m", choose("Cut", "x", 150)},
      {"cut at ", click("Cut at", 120)},
      {"walls off", click("Cut", 193)},
      {"section on", click("Show", 105)},
      {"section cuts away off", click("Cut away")},
      {"section: lines off", click("Lines")},
      {"section: fit on", click("Fit")},
      {"section: speed", choose("Field", "speed")},
      {"section: divided by none", choose("Divided", "by nothing")},
      {"section: its plane", choose("Plane", "across x")},
      {"section at ", click("At", 140)},
      {"section: its plane", choose("Plane", "at an angle")},
      {"section: its plane", click("Normal", 120)},
      {"camera", [this] { hands_.drag(500, 900, 560, 940); }},
      {"camera", click("Reset camera")},
      {"/boundary/handling=", [this] { hands_.press(Key::c); }},
      {"panels off", [this] { hands_.press(Key::h); }},
  };
  const Undoable start = now();
  for (const Control& control : controls) {
    SCOPED_TRACE(control.name);
    const Undoable before = now();
    control.use();
    rest();
    const Undoable after = now();
    ASSERT_FALSE(after == before);
    ASSERT_EQ(done().front().substr(0, control.name.size()), control.name);
    EXPECT_TRUE(hands_.press(Key::z, true).settings) << "the run is told";
    ASSERT_TRUE(now() == before);
    hands_.press(Key::y, true);
    ASSERT_TRUE(now() == after);
  }
  EXPECT_EQ(done().size(), controls.size());
  while (viewer_.changes().canUndo()) hands_.press(Key::z, true);
  EXPECT_TRUE(now() == start);
}

TEST_F(UndoWindow, ListsKeysTurnsAndTheWheelAreChangesEach) {
  const Undoable start = now();
  hands_.choose("Colour", "speed");
  EXPECT_EQ(viewer_.view().color, ColorField::speed);
  hands_.press(Key::c);
  ASSERT_EQ(viewer_.settings().boundary.handling, BoundaryHandling::none);
  hands_.drag(500, 900, 560, 940);
  EXPECT_NE(viewer_.view().camera, start.view.camera);
  for (int k = 0; k < 3; ++k) hands_.wheel(500, 900, 1);
  rest();
  hands_.wheel(500, 900, 1);
  rest();
  // A slider that is dragged is one change, whatever it passes.
  hands_.look();
  const auto tolerance = placeOfText("Tolerance");
  ASSERT_TRUE(tolerance);
  hands_.drag((*tolerance)[0] + 100, (*tolerance)[1], (*tolerance)[0] + 220, (*tolerance)[1]);
  hands_.look();
  const std::vector<std::string> names = done();
  ASSERT_EQ(names.size(), 6U) << ::testing::PrintToString(names);
  EXPECT_EQ(names[0].substr(0, 18), "/solver/tolerance=");
  EXPECT_EQ(names[1], "camera");
  EXPECT_EQ(names[2], "camera");
  EXPECT_EQ(names[3], "camera");
  EXPECT_EQ(names[4].substr(0, 19), "/boundary/handling=");
  EXPECT_EQ(names[5], "colour: speed");

  for (int k = 0; k < 6; ++k) hands_.press(Key::z, true);
  EXPECT_TRUE(now() == start);
  EXPECT_FALSE(viewer_.changes().canUndo());
  for (int k = 0; k < 6; ++k) hands_.press(Key::z, true, true);
  EXPECT_EQ(done(), names);
  // What is changed after something was taken back leaves nothing to do again.
  hands_.press(Key::z, true);
  EXPECT_TRUE(viewer_.changes().canRedo());
  hands_.press(Key::h);
  EXPECT_FALSE(viewer_.changes().canRedo());
}

TEST_F(UndoWindow, AClickInTheListTakesBackAllThatCameAfter) {
  const Undoable start = now();
  hands_.choose("Colour", "speed");
  hands_.press(Key::c);
  hands_.choose("Colour", "gamma");
  ASSERT_EQ(done().size(), 3U);
  hands_.clickOn("colour: speed");
  EXPECT_TRUE(now() == start);
  EXPECT_EQ(viewer_.changes().undone().size(), 3U);
  hands_.clickOn("Redo");
  EXPECT_EQ(viewer_.view().color, ColorField::speed);
  EXPECT_EQ(done().size(), 1U);
  hands_.clickOn("Undo");
  EXPECT_TRUE(now() == start);
}

TEST_F(UndoWindow, WhatTheRunRefusedIsNoChange) {
  const Settings before = viewer_.settings();
  hands_.press(Key::c);
  hands_.look();
  ASSERT_EQ(done().size(), 1U);
  viewer_.setSettings(before);
  EXPECT_FALSE(viewer_.changes().canUndo());
}

/// With a session, a simulation and the editor, as the window has them.
class UndoText : public ::testing::Test {
 protected:
  ~UndoText() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path written() const {
    std::ofstream(folder_ / "small.json") << R"({
  "format": 1, "particle_spacing": 0.1,
  "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [0.5, 0.6, 0.5]}],
  "boundary": {"surfaces": [{"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5]}]},
  "solver": {"time_step": 0.005, "max_iterations": 4}
})";
    return folder_ / "small.json";
  }
  UiCommands frame(const InputState& input) {
    simulation_->takeFrame(frame_);
    const UiCommands commands = viewer_->frame(frame_.view(), simulation_->status(), input, kWidth, kHeight);
    if (commands.settings) simulation_->apply(viewer_->settings());
    applyRequest(editor_, session_, viewer_->settings(), viewer_->view());
    return commands;
  }
  /// What was asked for is taken over.
  void await() {
    session_.wait();
    if (std::optional<SceneChange> change = session_.poll()) {
      tellEditor(*change, session_, editor_);
      applyChange(*change, session_, *viewer_, simulation_);
    }
    hands_.look();
  }

  std::filesystem::path folder_ = freshFolder("undo");
  std::unique_ptr<GlContext> context_ = makeEglContext();
  Scene scene_ = readScene(written(), {});
  SceneSession session_{scene_, {.overrides = {}, .threads = 1, .pace = Pace::unlimited}};
  std::unique_ptr<SimulationThread> simulation_ =
      std::make_unique<SimulationThread>(scene_, 1, Pace::unlimited);
  SceneEditor editor_ = makeEditor(session_);
  std::unique_ptr<Viewer> viewer_ = std::make_unique<Viewer>(simulation_->scene(), simulation_->walls(),
                                                             ViewerOptions{.scale = 1, .editor = &editor_});
  FrameSnapshot frame_;
  testing::Hands hands_{[this](const InputState& input) { return frame(input); }};
};

TEST_F(UndoText, ASceneThatWasTakenOverGoesBackWithTheSettingsOfBefore) {
  hands_.look(4);
  const std::string first = editor_.text;
  viewer_->view().color = ColorField::speed;
  hands_.look();
  // A setting that the text does not have.
  hands_.press(Key::c);
  ASSERT_EQ(viewer_->settings().boundary.handling, BoundaryHandling::none);

  std::string second = first;
  second.replace(second.find("\"max_iterations\": 4"), 19, "\"max_iterations\": 9");
  editor_.replaceText(second);
  editor_.apply = true;
  hands_.look();
  await();
  ASSERT_EQ(editor_.faults.size(), 0U);
  EXPECT_EQ(viewer_->settings().solver.maxIterations, 9);
  EXPECT_EQ(viewer_->settings().boundary.handling, BoundaryHandling::gamma) << "the text's";
  ASSERT_EQ(viewer_->changes().done().front(), "scene taken over");

  hands_.press(Key::z, true);
  await();
  EXPECT_EQ(editor_.text, first);
  EXPECT_EQ(viewer_->settings().solver.maxIterations, 4);
  EXPECT_EQ(viewer_->settings().boundary.handling, BoundaryHandling::none);
  EXPECT_EQ(viewer_->view().color, ColorField::speed);

  hands_.press(Key::y, true);
  await();
  EXPECT_EQ(editor_.text, second);
  EXPECT_EQ(viewer_->settings().solver.maxIterations, 9);

  for (int k = 0; k < 3; ++k) {
    hands_.press(Key::z, true);
    await();
  }
  EXPECT_FALSE(viewer_->changes().canUndo());
  EXPECT_EQ(viewer_->settings().boundary.handling, BoundaryHandling::gamma);
}

TEST_F(UndoText, WhatIsTakenBackWhileATextIsReadHoldsInTheEnd) {
  hands_.look(4);
  hands_.press(Key::c);
  hands_.look();
  const Settings before = viewer_->settings();
  const auto withIterations = [first = editor_.text](const char* number) {
    std::string text = first;
    text.replace(text.find("\"max_iterations\": 4"), 19, std::string("\"max_iterations\": ") + number);
    return text;
  };
  const auto take = [&](const std::string& text) {
    editor_.replaceText(text);
    editor_.apply = true;
    hands_.look();
  };
  // Back before the text has been read, and over two of them at once.
  take(withIterations("9"));
  hands_.press(Key::z, true);
  take(withIterations("8"));
  hands_.look();
  take(withIterations("7"));
  hands_.look();
  hands_.press(Key::z, true);
  hands_.press(Key::z, true);
  viewer_->view().color = ColorField::speed;
  hands_.look();
  for (int answer = 0; answer < 6; ++answer) await();
  EXPECT_EQ(viewer_->settings().solver.maxIterations, 4);
  EXPECT_EQ(viewer_->settings().boundary.handling, before.boundary.handling);
  EXPECT_EQ(viewer_->view().color, ColorField::speed) << "turned meanwhile";
  EXPECT_TRUE(viewer_->changes().canUndo());

  // A text with faults is not taken over; what was to hold with it does not hold with the next.
  take("{");
  take(withIterations("6"));
  for (int answer = 0; answer < 2; ++answer) await();
  ASSERT_EQ(viewer_->settings().solver.maxIterations, 6);
  hands_.press(Key::z, true);
  await();
  take(withIterations("5"));
  await();
  EXPECT_EQ(viewer_->settings().solver.maxIterations, 5);
}

TEST(UndoHistory, TakesBackOnlyWhatAChangeWasOf) {
  const auto settled = [](UndoHistory& history, const Undoable& state) {
    for (int k = 0; k < 2; ++k) history.look(state, false, 1);
  };
  Undoable state;
  UndoHistory history;
  history.begin(state);
  state.settings.solver.tolerance = 0.02;
  settled(history, state);
  state.view.water = true;
  settled(history, state);
  // The time line goes back to before the tolerance was changed.
  state.settings.solver.tolerance = 0.01;
  history.follow(state);
  const Undoable back = history.undo();
  EXPECT_FALSE(back.view.water);
  EXPECT_EQ(back.settings.solver.tolerance, 0.01);
  // A change whose end has not been seen is the last one, and leaves nothing to do again.
  state = back;
  state.view.camera.fovDegrees += 1;
  history.look(state, false, 0.01);
  EXPECT_FALSE(history.canRedo());
  EXPECT_EQ(history.done().front(), "camera");
  EXPECT_TRUE(history.undo() == back);
}

TEST_F(UndoText, AFileThatWasChangedElsewhereLeavesNothingToTakeBack) {
  hands_.look(4);
  hands_.press(Key::c);
  hands_.look();
  ASSERT_TRUE(viewer_->changes().canUndo());
  std::string text = editor_.text;
  text.replace(text.find("\"max_iterations\": 4"), 19, "\"max_iterations\": 7");
  writeTextFile(folder_ / "small.json", text);
  for (int k = 0; k < 50 && viewer_->settings().solver.maxIterations != 7; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    await();
  }
  ASSERT_EQ(viewer_->settings().solver.maxIterations, 7);
  EXPECT_FALSE(viewer_->changes().canUndo());
}

}  // namespace undo_test
}  // namespace migiwa
