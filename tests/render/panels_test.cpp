// Panels and mouse through the same frame() that a window uses, with input made up.
#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/viewer/viewer.h"
#include "tests/render/hands.h"
#include "tests/render/image_compare.h"
#include "tests/render/test_scene.h"
#include "tests/render/window_over_scene.h"
#include "tests/support/test_effects.h"

namespace migiwa {
namespace panels_test {

constexpr int kWidth = 1280, kHeight = 720;

class PanelsTest : public ::testing::Test {
 protected:
  UiCommands frame(const InputState& input) {
    return viewer_.frame(frame_.view(), run_, input, kWidth, kHeight);
  }

  static InputState mouseAt(float x, float y, bool pressed = false) {
    InputState input;
    input.mouseInside = true;
    input.mouseX = x, input.mouseY = y;
    input.buttons[0] = pressed;
    return input;
  }

  /// Moves there, presses for two frames, lets go: the commands of all frames together.
  UiCommands click(float x, float y) {
    UiCommands all;
    for (const bool pressed : {false, false, true, true, false, false}) {
      const UiCommands now = frame(mouseAt(x, y, pressed));
      all.play |= now.play, all.pause |= now.pause, all.step |= now.step, all.reset |= now.reset;
      all.settings |= now.settings, all.savePicture |= now.savePicture;
    }
    return all;
  }

  static InputState key(Key key) {
    InputState input;
    input.keys[static_cast<std::size_t>(key)] = true;
    return input;
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  FrameSnapshot frame_ = frameOf({Vec3f(0.5F, 0.4F, 0.25F)}, 0.1F);
  RunStatus run_;
  Viewer viewer_{smallScene(), {}, {1, true, true}};
};

TEST_F(PanelsTest, WaterIsABoxInTheRowOfTheColour) {
  testing::Hands hands([this](const InputState& input) { return frame(input); });
  hands.clickOn("Water");
  EXPECT_TRUE(viewer_.view().water);
}

TEST_F(PanelsTest, PlayStepAndResetAreAskedForByTheirButtons) {
  EXPECT_TRUE(click(55, 40).play);
  EXPECT_TRUE(click(160, 40).step);
  EXPECT_TRUE(click(260, 40).reset);
  run_.playing = true;
  const UiCommands commands = click(55, 40);
  EXPECT_TRUE(commands.pause);
  EXPECT_FALSE(commands.play);
}

TEST_F(PanelsTest, StoppedSimulationOffersResetOnly) {
  run_ = {false, true, "lost_particle at step 3: 1 particle left the tank"};
  EXPECT_FALSE(click(55, 40).play);
  EXPECT_TRUE(click(260, 40).reset);
}

TEST_F(PanelsTest, HeldSimulationOffersToPauseOnly) {
  run_.heldFor = "a test";
  EXPECT_FALSE(click(55, 40).play);
  EXPECT_FALSE(click(160, 40).step);
  EXPECT_FALSE(click(260, 40).reset);
  run_.playing = true;
  EXPECT_TRUE(click(55, 40).pause);
}

TEST_F(PanelsTest, HandlingOfWallsIsPickedFromItsListAndSwitchedByItsKey) {
  ASSERT_EQ(viewer_.settings().boundary.handling, BoundaryHandling::gamma);
  EXPECT_FALSE(click(200, 109).settings) << "opens the list";
  EXPECT_TRUE(click(200, 159).settings);
  EXPECT_EQ(viewer_.settings().boundary.handling, BoundaryHandling::none);
  EXPECT_TRUE(frame(key(Key::c)).settings);
  EXPECT_EQ(viewer_.settings().boundary.handling, BoundaryHandling::gamma);
}

TEST_F(PanelsTest, MaxIterationsFollowTheirSlider) {
  const int before = viewer_.settings().solver.maxIterations;
  EXPECT_TRUE(click(280, 224).settings);
  EXPECT_GT(viewer_.settings().solver.maxIterations, before);
  EXPECT_GE(viewer_.settings().solver.maxIterations, viewer_.settings().solver.minIterations);
}

TEST(EffectPanels, AreThereForTheEffectsOfTheSceneAndChangeThem) {
  const auto context = makeEglContext();
  const FrameSnapshot snapshot = frameOf({Vec3f(0.5F, 0.4F, 0.25F)}, 0.1F);
  Scene scene = smallScene();
  const auto panels = [&] {
    Viewer viewer(scene, {}, {1, true, true});
    return viewer.takePicture(snapshot.view(), RunStatus{}, kWidth, 1400);
  };
  scene.effects.clear();
  const Image none = panels();
  scene.effects = testing::effectsOf(R"({"wall_friction": {}, "artificial_pressure": {}})");
  EXPECT_GT(differentShare(none, panels()), 0.01);

  // Somewhere in the right half of the panels lies a slider of an effect: pressed, it puts another effect in
  // the place of the scene's. Each try begins anew, for a press on a heading folds it.
  bool changed = false;
  for (float y = 300; y < 1000 && !changed; y += 12) {
    Viewer viewer(scene, {}, {1, true, true});
    for (const bool pressed : {false, true, true, false}) {
      InputState input;
      input.mouseInside = true;
      input.mouseX = 280, input.mouseY = y;
      input.buttons[0] = pressed;
      const UiCommands commands = viewer.frame(snapshot.view(), RunStatus{}, input, kWidth, 1400);
      changed |= commands.settings && viewer.settings().effects[0].effect != scene.effects[0].effect;
    }
  }
  EXPECT_TRUE(changed);
}

TEST_F(PanelsTest, DraggingTheSceneTurnsTheCameraAndThePanelsDoNot) {
  const Vec3d eye = viewer_.view().camera.eye;
  for (int i = 0; i < 4; ++i) frame(mouseAt(100 + 20.0F * static_cast<float>(i), 650, i > 0));
  frame(mouseAt(180, 650));
  EXPECT_EQ(viewer_.view().camera.eye, eye);
  for (int i = 0; i < 4; ++i) frame(mouseAt(800 + 20.0F * static_cast<float>(i), 400, i > 0));
  EXPECT_GT((viewer_.view().camera.eye - eye).norm(), 0.05);
}

TEST_F(PanelsTest, WheelComesNearer) {
  const auto distance = [&] { return (viewer_.view().camera.eye - viewer_.view().camera.target).norm(); };
  const double before = distance();
  InputState input = mouseAt(800, 400);
  frame(input);
  input.wheel = 1;
  frame(input);
  EXPECT_NEAR(distance(), 0.9 * before, 1e-9);
}

TEST_F(PanelsTest, DoubleClickLooksAtTheParticle) {
  viewer_.view().camera.target = {0.6, 0.5, 0.25};
  frame(mouseAt(700, 400));
  // The particle's place on the screen: 0.1 m to the left and below the middle of the scene's part.
  const Rect scene{321, 0, kWidth - 321, kHeight};
  const Projection projection = makeProjection(viewer_.view().camera, kWidth, kHeight, scene);
  const Eigen::Vector4f clip = projection.clip * projection.view * Eigen::Vector4f(0.5F, 0.4F, 0.25F, 1);
  const float x = 321 + (0.5F + 0.5F * clip.x() / clip.w()) * static_cast<float>(scene.width);
  const float y = (0.5F - 0.5F * clip.y() / clip.w()) * kHeight;
  for (const bool pressed : {false, true, false, true, false}) frame(mouseAt(x, y, pressed));
  // The front of the particle, half its diameter nearer than its centre.
  EXPECT_NEAR((viewer_.view().camera.target - Vec3d(0.5, 0.4, 0.25)).norm(), 0.05, 0.01);
}

TEST_F(PanelsTest, PanelsAreHiddenByTheirKey) {
  frame(InputState{});
  const Image with = viewer_.picture();
  frame(key(Key::h));
  frame(InputState{});
  const Image without = viewer_.picture();
  EXPECT_LT(with.pixel(310, 700)[0], 60) << "the dark panel";
  EXPECT_GT(without.pixel(310, 700)[0], 150) << "the scene";
}

class PanelsTogether : public WindowOverScene {
 protected:
  PanelsTogether() : WindowOverScene("panels_together") {}

  void pressRow(const std::string& label) {
    hands_.look();
    const auto place = placeOfWidget(label);
    ASSERT_TRUE(place) << shownText();
    hands_.click((*place)[0], (*place)[1]);
    hands_.look();
  }
};

TEST_F(PanelsTogether, ListsOfTwoPanelsStayApart) {
  open();
  const int gammaMethod = window_->viewer().settings().boundary.gammaMethod;
  pressRow("Method");
  EXPECT_EQ(shownText().find("copula"), std::string::npos) << "methods of gamma among solvers";
  hands_.clickOn("dfsph");
  EXPECT_EQ(window_->viewer().settings().solver.method, SolverMethod::dfsph);
  EXPECT_EQ(window_->viewer().settings().boundary.gammaMethod, gammaMethod);
  pressRow("Method of γ");
  EXPECT_EQ(shownText().find("pcisph"), std::string::npos) << "solvers among methods of gamma";
}

TEST_F(PanelsTogether, ButtonsOfOneNameAreEachPressed) {
  open();
  for (const char* const panel : {"Boundary", "Solver", "Energy", "Performance"}) hands_.clickOn(panel);
  ASSERT_TRUE(placeOfText("Selected")) << shownText();
  hands_.clickOn("Measure");
  await([] { return placeOfText("Try").has_value(); });
  const auto last = placeOfText("Clear", true);
  ASSERT_NE(last, placeOfText("Clear")) << shownText();
  hands_.click((*last)[0], (*last)[1]);
  hands_.look();
  EXPECT_TRUE(placeOfText("Measure")) << shownText();
}

}  // namespace panels_test
}  // namespace migiwa
