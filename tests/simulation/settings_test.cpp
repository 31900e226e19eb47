// Settings of a running simulation are taken over wholly or not at all: after a refusal it goes on as if
// nothing had been asked. Run it under the address sanitizer, too.
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/simulation/simulation.h"
#include "core/walls/shapes.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace settings_test {

int gammaMethod(std::string_view name) {
  const auto names = gammaMethodNames();
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

BoundaryHandling handling(std::string_view name) {
  const auto names = handlingNames();
  return static_cast<BoundaryHandling>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Within a sphere so large that nothing which fills space about it has room in memory.
Scene vastScene() {
  Scene scene = smallDamBreak();
  scene.surfaces.push_back(std::make_shared<Sphere>(Vec3d::Zero(), 1e4, Sphere::Fluid::inside));
  return scene;
}

/// The same, with a wall that moves.
Scene movingScene() {
  Scene scene = vastScene();
  auto pusher = std::make_shared<Box>(Vec3d(0.8, -0.1, -0.1), Vec3d(1.2, 0.9, 0.4), Box::Fluid::outside);
  pusher->motion.emplace();
  pusher->motion->velocity = {-0.5, 0, 0};
  scene.surfaces.push_back(pusher);
  return scene;
}

struct Refused {
  std::string place;
  Settings settings;
};

/// What cannot be had of these scenes, each time with changes that could be.
std::vector<Refused> refused(const Settings& now) {
  std::vector<Refused> all;
  for (const char* method : {"baked", "monte_carlo"}) {
    Refused one{"test.json:/boundary/gamma/method", now};
    one.settings.boundary.gammaMethod = gammaMethod(method);
    all.push_back(one);
  }
  Refused particles{"test.json:/boundary/handling", now};
  particles.settings.boundary.handling = handling("particles");
  all.push_back(particles);
  const std::size_t alone = all.size();
  for (std::size_t k = 0; k < alone; ++k) {
    Refused one = all[k];
    one.settings.solver.supportRatio = 2.5;
    one.settings.solver.kernel = KernelType::wendlandC2;
    one.settings.solver.timeStep = 0.001;
    one.settings.effects.clear();
    all.push_back(one);
  }
  return all;
}

/// Where it is refused; empty: it was taken over.
std::string refusalOf(Simulation& simulation, const Settings& settings) {
  try {
    simulation.apply(settings);
  } catch (const InputError& error) {
    return error.faults().front().place;
  }
  return "";
}

class SettingsOf : public ::testing::TestWithParam<Scene (*)()> {};

TEST_P(SettingsOf, ARefusalLeavesEverythingAsItWas) {
  const Scene scene = GetParam()();
  Simulation asked(scene, 1), undisturbed(scene, 1);
  for (const Refused& one : refused(asked.settings())) {
    asked.advanceFrame(), undisturbed.advanceFrame();
    EXPECT_EQ(refusalOf(asked, one.settings), one.place);
    EXPECT_EQ(asked.settings().boundary.gammaMethod, undisturbed.settings().boundary.gammaMethod);
    EXPECT_EQ(asked.settings().boundary.handling, undisturbed.settings().boundary.handling);
    EXPECT_EQ(asked.settings().solver.supportRatio, undisturbed.settings().solver.supportRatio);
    EXPECT_EQ(asked.settings().solver.timeStep, undisturbed.settings().solver.timeStep);
    EXPECT_EQ(asked.settings().effects.size(), undisturbed.settings().effects.size());
    EXPECT_EQ(asked.view().info.handling, undisturbed.view().info.handling);
    EXPECT_EQ(asked.view().info.supportRadius, undisturbed.view().info.supportRadius);
    EXPECT_EQ(asked.statistics().gammaPicked, undisturbed.statistics().gammaPicked);
    EXPECT_EQ(asked.statistics().gammaReason, undisturbed.statistics().gammaReason);
    asked.advanceFrame(), undisturbed.advanceFrame();
    ASSERT_EQ(asked.stateHash(), undisturbed.stateHash());
  }
}

TEST_P(SettingsOf, AfterARefusalOthersAreTakenOver) {
  Simulation asked(GetParam()(), 1), undisturbed(GetParam()(), 1);
  Settings good = asked.settings();
  good.solver.supportRatio = 2.2;
  good.boundary.gammaMethod = gammaMethod("directions");
  Settings bad = good;
  bad.boundary.gammaMethod = gammaMethod("baked");
  EXPECT_EQ(refusalOf(asked, bad), "test.json:/boundary/gamma/method");
  EXPECT_EQ(refusalOf(asked, good), "");
  undisturbed.apply(good);
  for (int frame = 0; frame < 3; ++frame) asked.advanceFrame(), undisturbed.advanceFrame();
  EXPECT_EQ(asked.stateHash(), undisturbed.stateHash());
  EXPECT_EQ(asked.view().info.handling, "gamma: directions");
}

INSTANTIATE_TEST_SUITE_P(Scenes, SettingsOf, ::testing::Values(&vastScene, &movingScene),
                         [](const auto& one) { return one.index == 0 ? "StillWalls" : "MovingWalls"; });

TEST(Settings, AReferenceIsNoMethodOfASimulation) {
  Scene scene = smallDamBreak();
  scene.boundary.gammaMethod = gammaMethod("monte_carlo");
  try {
    const Simulation simulation(scene, 1);
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().front().place, "test.json:/boundary/gamma/method");
    EXPECT_NE(error.faults().front().message.find("\"auto\""), std::string::npos) << "the remedy";
  }
  // Where nothing asks for gamma, its method does not matter.
  scene.boundary.handling = BoundaryHandling::none;
  EXPECT_NO_THROW(Simulation(scene, 1));
  // All others can be simulated with.
  scene.boundary.handling = BoundaryHandling::gamma;
  ASSERT_EQ(steppedGammaMethodNames().size() + 1, gammaMethodNames().size());
  for (std::size_t k = 0; k < steppedGammaMethodNames().size(); ++k) {
    scene.boundary.gammaMethod = static_cast<int>(k);
    EXPECT_NO_THROW(Simulation(scene, 1)) << steppedGammaMethodNames()[k];
  }
}

}  // namespace settings_test
}  // namespace migiwa::testing
