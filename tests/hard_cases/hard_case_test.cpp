// Every case of hardCases() keeps what it states, with the same bits for any number of threads.
#include "tests/hard_cases/hard_case.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace hard_case_test {

std::string testName(const HardCase& hardCase) {
  std::string name = hardCase.name;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

class HardCases : public ::testing::TestWithParam<HardCase> {};

TEST_P(HardCases, KeepWhatTheyState) {
  const Scene scene = sceneOf(GetParam());
  const Observed one = observe(scene, GetParam().until, 1);
  for (const std::string& violation : violations(GetParam(), one)) ADD_FAILURE() << violation;
  EXPECT_EQ(observe(scene, GetParam().until, 3).hash, one.hash) << "with 3 threads";
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardCases, ::testing::ValuesIn(hardCases()),
                         [](const auto& one) { return testName(one.param); });

TEST(BrokenMeshes, InvertedTrianglesChangeNoBit) {
  // Their fits are of the same mesh once it is repaired.
  HardCase hardCase;
  hardCase.scene = "slim_shell";
  const Observed whole = observe(sceneOf(hardCase), 0.2, 1);
  hardCase.scene = "slim_shell_inverted";
  EXPECT_EQ(observe(sceneOf(hardCase), 0.2, 1).hash, whole.hash);
}

class EveryMethod : public ::testing::TestWithParam<HardCase> {};

TEST_P(EveryMethod, KeepsWhatTheCaseStates) {
  for (const std::string method : {"product", "copula", "directions", "mean", "nearest"}) {
    Observed seen = observe(sceneOf(GetParam(), method), GetParam().until, 1);
    // Gamma of a method that is not made for these walls shakes the water: what that would gain may be taken
    // back.
    if (GetParam().guards.empty()) std::erase(seen.guards, "energy_held");
    for (const std::string& violation : violations(GetParam(), seen))
      ADD_FAILURE() << method << ": " << violation;
  }
}

std::vector<HardCase> casesOfEveryMethod() {
  std::vector<HardCase> cases;
  for (const HardCase& hardCase : hardCases())
    if (hardCase.everyMethod) cases.push_back(hardCase);
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Scenes, EveryMethod, ::testing::ValuesIn(casesOfEveryMethod()),
                         [](const auto& one) { return testName(one.param); });

class ByProjection : public ::testing::TestWithParam<HardCase> {};

// With velocities by projection, as the scene is run by default. Which guards have to act is not stated.
TEST_P(ByProjection, KeepsWhatTheCaseStates) {
  const Scene scene = sceneOf(GetParam(), {}, VelocityStep::projection);
  Observed seen = observe(scene, GetParam().until, 1);
  seen.guards = GetParam().guards;
  for (const std::string& violation : violations(GetParam(), seen)) ADD_FAILURE() << violation;
}

std::vector<HardCase> casesByProjection() {
  std::vector<HardCase> cases;
  for (const HardCase& hardCase : hardCases())
    if (hardCase.byProjection) cases.push_back(hardCase);
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Scenes, ByProjection, ::testing::ValuesIn(casesByProjection()),
                         [](const auto& one) { return testName(one.param); });

/// In the soak alone: the same bits with any number of threads, and no method of gamma that loses a particle,
/// leaves what is finite, or gives the fluid energy. A method that is not made for a case's walls may shake
/// water at rest, which viscosity drains: asked is that both together give none.
class Soak : public ::testing::TestWithParam<HardCase> {};

TEST_P(Soak, HoldsWithEveryMethodAndThreadCount) {
  const double until = std::min(GetParam().until, 5.0);
  const std::uint64_t hash = observe(sceneOf(GetParam()), until, 1).hash;
  for (const int threads : {2, 5, 16, 64})
    EXPECT_EQ(observe(sceneOf(GetParam()), until, threads).hash, hash) << threads << " threads";
  for (const std::string method : {"mean", "nearest", "product", "copula", "directions", "baked"}) {
    SCOPED_TRACE(method);
    try {
      const Observed seen = observe(sceneOf(GetParam(), method), until, 1);
      EXPECT_EQ(seen.nonfinite, 0);
      EXPECT_EQ(seen.lost, 0);
      EXPECT_LE(seen.energyGain, seen.energyBound);
    } catch (const InputError& refused) {
      // Grids of gamma over a kilometre fit no memory, and that is what it has to say.
      EXPECT_EQ(method, "baked") << refused.what();
      EXPECT_NE(std::string(refused.what()).find("GiB"), std::string::npos) << refused.what();
    }
  }
}

std::vector<HardCase> soakCases() {
  return std::getenv("MIGIWA_SOAK") != nullptr ? hardCases() : std::vector<HardCase>();
}
INSTANTIATE_TEST_SUITE_P(Scenes, Soak, ::testing::ValuesIn(soakCases()),
                         [](const auto& one) { return testName(one.param); });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Soak);

}  // namespace hard_case_test
}  // namespace migiwa::testing
