// A copy that goes on from a moment of a run does what the run itself does.
#include <gtest/gtest.h>

#include "core/simulation/state.h"
#include "core/study/study.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace what_if_test {

using namespace migiwa::testing;

TEST(StateImage, ACopyGoesTheWayOfTheRun) {
  const Scene scene = smallDamBreak();
  Simulation run(scene, 1), copy(scene, 2);
  for (int k = 0; k < 30; ++k) run.advanceFrame();
  const StateImage image = StateImage::of(run);
  for (int round = 0; round < 2; ++round) {
    image.restore(copy);
    EXPECT_EQ(copy.time(), run.time());
    EXPECT_EQ(copy.stateHash(), run.stateHash());
    copy.advanceFrame();
  }
  run.advanceFrame();
  EXPECT_EQ(copy.stateHash(), run.stateHash());
}

TEST(StateImage, AnotherScenesStateIsRefused) {
  Simulation run(smallDamBreak(), 1);
  EXPECT_THROW(StateImage().restore(run), StateError);
}

TEST(WhatIf, WithTheSettingsOfNowItIsTheRunsFuture) {
  const Scene scene = smallDamBreak();
  Simulation run(scene, 1);
  for (int k = 0; k < 30; ++k) run.advanceFrame();
  WhatIf whatIf(scene, 1);
  const StateImage image = StateImage::of(run);
  const WhatIfAnswer answer = whatIf.ask(image, run.settings());
  EXPECT_EQ(answer.time, run.time());

  // A change of settings has gamma evaluated anew everywhere, so the run takes one, too.
  run.apply(run.settings());
  for (int k = 0; k < WhatIf::kFrames; ++k) run.advanceFrame();
  ReferenceSampler sampler(1);
  sampler.sample(run);
  EXPECT_EQ(answer.errors.densityMean, sampler.result().densityMean);
  EXPECT_EQ(answer.errors.gammaMean, sampler.result().gammaMean);
  EXPECT_EQ(answer.solverError, run.view().info.errors.back().mean);
  EXPECT_EQ(answer.handling, run.view().info.handling);
  EXPECT_GT(answer.stepSeconds, 0);
  EXPECT_TRUE(answer.trouble.empty());
}

}  // namespace what_if_test
}  // namespace migiwa
