// Vessels that open into each other.
#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/walls/boundary.h"

namespace migiwa {
namespace group_test {

std::string groupOf(const std::string& vessels, const std::string& more = {}) {
  return R"({ "format": 1, "particle_spacing": 0.05, "boundary": { "surfaces": [ { "shape": "group", "surfaces": [ )" +
         vessels + " ] } ] }" + more + " }";
}

std::string box(const std::string& min, const std::string& max, const std::string& fluid = "inside") {
  return R"({ "shape": "box", "fluid": ")" + fluid + R"(", "min": )" + min + R"(, "max": )" + max + " }";
}

/// Two tanks and a channel that touches one and reaches into the other.
const std::string kTwoTanks = box("[0, 0, 0]", "[1, 1, 1]") + ", " + box("[2, 0, 0]", "[3, 1, 1]") + ", " +
                              box("[1, 0, 0.4]", "[2.2, 0.3, 0.7]");

TEST(Group, IsFluidWhereAnyVesselIs) {
  const Scene scene = parseScene(groupOf(kTwoTanks), "scene.json");
  const Boundary walls(scene.surfaces);
  // In both tanks, in the channel and in its mouths; not between the tanks, nor around them.
  EXPECT_NEAR(walls.distance({0.5F, 0.5F, 0.5F}), 0.5, 1e-5);
  EXPECT_NEAR(walls.distance({1.5F, 0.15F, 0.55F}), 0.15, 1e-5);
  EXPECT_NEAR(walls.distance({1, 0.15F, 0.55F}), 0.15, 1e-5);
  EXPECT_NEAR(walls.distance({2, 0.15F, 0.55F}), 0.15, 1e-5);
  EXPECT_NEAR(walls.distance({1.5F, 0.5F, 0.55F}), -0.2, 1e-5);
  EXPECT_LT(walls.distance({0.5F, 1.1F, 0.5F}), 0);
}

TEST(Group, OfBallAndTubeIsTheirUnion) {
  const Scene scene =
      parseScene(groupOf(R"({ "shape": "sphere", "fluid": "inside", "center": [0, 0, 0], "radius": 1 }, )" +
                         box("[-0.1, 0, -0.1]", "[0.1, 3, 0.1]")),
                 "scene.json");
  const Boundary walls(scene.surfaces);
  EXPECT_NEAR(walls.distance({0, -0.5F, 0}), 0.5, 5e-4);
  EXPECT_NEAR(walls.distance({0, 2, 0}), 0.1, 1e-5);
  EXPECT_NEAR(walls.distance({0.5F, 2, 0}), -0.4, 1e-5);
}

/// Water poured into one stands as high in the other in the end.
TEST(CommunicatingVessels, WaterFindsItsLevelThroughTheChannel) {
  const std::string tanks = box("[0, 0, 0]", "[0.6, 1.2, 0.3]") + ", " +
                            box("[0.8, 0, 0]", "[1.4, 1.2, 0.3]") + ", " +
                            box("[0.6, 0, 0]", "[0.8, 0.3, 0.3]");
  Simulation simulation(
      parseScene(
          groupOf(tanks, R"(, "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.6, 0.9, 0.3] } ],
                 "effects": { "viscosity": { "xsph": 0.3 } })"),
          "scene.json"),
      2);
  const std::size_t all = simulation.view().positions.size();
  ASSERT_EQ(all, 12U * 18 * 6);
  while (simulation.time() < 6 && !simulation.stopped()) simulation.advanceFrame();
  std::size_t left = 0, right = 0;
  for (const Float4& p : simulation.view().positions) {
    left += p.x < 0.6F ? 1 : 0;
    right += p.x > 0.8F ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(right) / static_cast<double>(left), 1, 0.08);
  EXPECT_EQ(simulation.view().positions.size(), all);
}

TEST(Group, RefusesWhatIsNoVessel) {
  const auto faultsOf = [](const std::string& vessels) {
    try {
      parseScene(groupOf(vessels), "scene.json");
    } catch (const InputError& error) {
      std::string all;
      for (const Fault& fault : error.faults()) all += fault.place + ": " + fault.message + "\n";
      return all;
    }
    return std::string("none");
  };
  EXPECT_NE(faultsOf(box("[0, 0, 0]", "[1, 1, 1]", "outside")).find("expected \"fluid\": \"inside\""),
            std::string::npos);
  EXPECT_NE(faultsOf("").find("expected at least one vessel, found none"), std::string::npos);
  EXPECT_NE(faultsOf(R"({ "shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0] })").find("shape"),
            std::string::npos);
}

}  // namespace group_test
}  // namespace migiwa
