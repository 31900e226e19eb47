// Effects together: determinism, what a step lists, and what a change between two steps does.
#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "tests/support/test_effects.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace all_effects_test {

using namespace migiwa::testing;

const char* const kAll = R"({"viscosity": {"kinematic": 0.001}, "vorticity_confinement": {},
  "surface_tension": {"coefficient": 1}, "artificial_pressure": {}, "wall_friction": {}})";

std::vector<std::string> stageNames(const Simulation& simulation) {
  std::vector<std::string> names;
  for (const StageTime& stage : simulation.view().info.stages.stages()) names.push_back(stage.name);
  return names;
}

TEST(AllEffects, TheHashIsTheSameForAnyNumberOfThreads) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.5, 0.6, 0.5});
  addTank(scene, Vec3d::Zero(), {1, 1, 0.5});
  scene.effects = effectsOf(kAll);
  const auto hashAfter = [&](int threads) {
    Simulation simulation(scene, threads);
    for (int k = 0; k < 30; ++k) simulation.advanceFrame();
    EXPECT_FALSE(simulation.stopped());
    return simulation.stateHash();
  };
  const std::uint64_t one = hashAfter(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hashAfter(threads), one) << threads;
}

TEST(AllEffects, AStepListsThoseThatTheSceneNames) {
  Scene scene = smallDamBreak();
  scene.effects.clear();
  Simulation none(scene, 1);
  none.advanceFrame();
  EXPECT_EQ(stageNames(none),
            (std::vector<std::string>{"predict", "neighbours", "gamma", "lambda", "position", "projection",
                                      "gamma_refresh", "velocity", "check"}));
  scene.effects = effectsOf(kAll);
  Simulation all(scene, 1);
  all.advanceFrame();
  const std::vector<std::string> names = stageNames(all);
  for (const std::string_view effect : effectNames())
    EXPECT_EQ(std::count(names.begin(), names.end(), effect), 1) << effect;
  EXPECT_EQ(names.size(), 9 + effectNames().size());
}

TEST(AllEffects, TheirParametersChangeBetweenTwoSteps) {
  Scene scene = smallDamBreak();
  scene.effects = effectsOf(R"({"viscosity": {"xsph": 0}})");
  Simulation simulation(scene, 1);
  simulation.advanceFrame();
  EXPECT_EQ(stageNames(simulation).size(), 9U) << "an effect of no strength is no stage";
  Settings settings = simulation.settings();
  settings.effects = effectsOf(R"({"viscosity": {"xsph": 0.5}})");
  simulation.apply(settings);
  simulation.advanceFrame();
  EXPECT_EQ(stageNames(simulation).size(), 10U);
  scene.effects = effectsOf(R"({"viscosity": {"xsph": 0.5}})");
  Simulation other(scene, 1);
  other.advanceFrame();
  other.advanceFrame();
  EXPECT_NE(other.stateHash(), simulation.stateHash()) << "it acted in the second frame only";
}

}  // namespace all_effects_test
}  // namespace migiwa
