// Settings tried on a copy of a run, through the panel: what is measured, and that the run does not notice.
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/session/session.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace what_if_test {

using namespace migiwa::testing;
namespace fs = std::filesystem;

constexpr int kWidth = 1280, kHeight = 1440;

class WhatIfTest : public ::testing::Test {
 protected:
  static Scene scene() {
    Scene scene = smallDamBreak();
    scene.view.camera = {{1.2, 0.9, 2.2}, {0.45, 0.3, 0.15}};
    return scene;
  }
  void stepTo(long frames) {
    while (frame_.info.steps < frames) {
      const long before = frame_.info.steps;  // that of the start is still to be taken at first
      simulation_->step();
      while (!simulation_->takeFrame(frame_) || frame_.info.steps == before) std::this_thread::yield();
      viewer_->frame(frame_.view(), simulation_->status(), InputState{}, kWidth, kHeight);
    }
  }
  /// Asks, and takes in the answer.
  void ask() {
    model_.ask = true;
    EXPECT_TRUE(session_.poll(model_, *simulation_, viewer_->settings()));
    EXPECT_TRUE(model_.busy);
    session_.wait();
    EXPECT_TRUE(session_.poll(model_, *simulation_, viewer_->settings()));
    EXPECT_FALSE(model_.busy);
  }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  std::unique_ptr<SimulationThread> simulation_ =
      std::make_unique<SimulationThread>(scene(), 1, Pace::unlimited);
  WhatIfModel model_;
  WhatIfSession session_{1};
  std::unique_ptr<Viewer> viewer_ = std::make_unique<Viewer>(simulation_->scene(), simulation_->walls(),
                                                             ViewerOptions{.scale = 1, .whatIf = &model_});
  FrameSnapshot frame_;
};

TEST_F(WhatIfTest, PointsOfOneMomentStandBesideEachOther) {
  stepTo(40);
  ask();
  ASSERT_EQ(model_.points.size(), 1U);
  EXPECT_TRUE(model_.points[0].trouble.empty());
  ASSERT_TRUE(model_.points[0].gammaError && model_.points[0].densityError);
  EXPECT_LT(*model_.points[0].gammaError, 0.01);

  model_.follows = false;
  model_.asked.boundary.handling = BoundaryHandling::none;
  ask();
  model_.asked = viewer_->settings();
  model_.asked.solver.maxIterations = 50;
  model_.asked.solver.minIterations = 1;
  model_.asked.solver.tolerance = 5e-4;
  ask();
  ASSERT_EQ(model_.points.size(), 3U);
  // Without correction gamma is 1 where it should be 1/2 at walls; more iterations leave less compression.
  EXPECT_GT(*model_.points[1].gammaError, 0.1);
  EXPECT_LT(*model_.points[2].densityError, *model_.points[0].densityError);
  EXPECT_GT(model_.points[2].iterations, model_.points[0].iterations);
  EXPECT_NE(model_.points[1].label.find("no correction"), std::string::npos) << model_.points[1].label;

  // The run itself goes on as if nobody had asked.
  Simulation undisturbed(scene(), 1);
  for (int k = 0; k < 45; ++k) undisturbed.advanceFrame();
  stepTo(45);
  EXPECT_EQ(frame_.info.stateHash, undisturbed.stateHash());

  for (int k = 0; k < 3; ++k)
    viewer_->frame(frame_.view(), simulation_->status(), InputState{}, kWidth, kHeight);
  fs::create_directories(MIGIWA_PICTURES);
  writeTextFile(fs::path(MIGIWA_PICTURES) / "what_if.png", encodePng(viewer_->picture()));

  model_.clear = true;
  session_.poll(model_, *simulation_, viewer_->settings());
  EXPECT_TRUE(model_.points.empty());
}

TEST_F(WhatIfTest, ARunThatPlaysWaitsAndPlaysOn) {
  simulation_->play();
  model_.ask = true;
  session_.poll(model_, *simulation_, viewer_->settings());
  EXPECT_FALSE(simulation_->status().heldFor.empty());
  session_.wait();
  session_.poll(model_, *simulation_, viewer_->settings());
  EXPECT_TRUE(simulation_->status().heldFor.empty());
  EXPECT_TRUE(simulation_->status().playing);
}

TEST_F(WhatIfTest, WhatWasAskedOfAnotherSceneIsDropped) {
  model_.ask = true;
  session_.poll(model_, *simulation_, viewer_->settings());
  session_.forget(model_, *simulation_);
  session_.wait();
  session_.poll(model_, *simulation_, viewer_->settings());
  EXPECT_TRUE(model_.points.empty());
  ask();
  EXPECT_EQ(model_.points.size(), 1U);
}

}  // namespace what_if_test
}  // namespace migiwa
