// Water on both sides of a plate, as thin as a twentieth of the support radius: each side must be as if the
// other were not there.
#include <map>

#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"

namespace migiwa::testing {
namespace plate_test {

/// Of the fluid on one side.
struct Side {
  std::size_t particles = 0;
  double level = 0;  ///< twice the height of the centre of mass (m)
  double error = 0;  ///< mean of max(rho/rho0 - 1, 0)
};

constexpr double kDuration = 2, kSpacing = 0.05;
constexpr float kPlate = 0.3F;  ///< its left face (m)

Side sideOf(const FrameView& view, bool left) {
  Side side;
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    if ((view.positions[i].x < kPlate) != left) continue;
    ++side.particles;
    side.level += 2 * static_cast<double>(view.positions[i].y);
    side.error += std::max(static_cast<double>(view.density[i]) - 1, 0.0);
  }
  side.level /= static_cast<double>(side.particles);
  side.error /= static_cast<double>(side.particles);
  return side;
}

void advance(Simulation& simulation) {
  while (simulation.time() < kDuration && !simulation.stopped()) simulation.advanceFrame();
}

Scene plateScene(const std::string& name) {
  HardCase hardCase;
  hardCase.scene = name;
  return sceneOf(hardCase);
}

class Plates : public ::testing::TestWithParam<std::string> {};

TEST_P(Plates, KeepTheTwoSidesApart) {
  const Scene scene = plateScene(GetParam());
  Simulation both(scene, 1);
  std::map<std::uint32_t, bool> wasLeft;
  for (std::size_t i = 0; i < both.view().ids.size(); ++i)
    wasLeft[both.view().ids[i]] = both.view().positions[i].x < kPlate;
  advance(both);
  for (std::size_t i = 0; i < both.view().ids.size(); ++i)
    EXPECT_EQ(both.view().positions[i].x < kPlate, wasLeft.at(both.view().ids[i]))
        << "particle " << both.view().ids[i] << " has passed";

  const double area = 0.3 * 0.3;
  for (const bool left : {true, false}) {
    SCOPED_TRACE(left ? "left" : "right");
    const Side seen = sideOf(both.view(), left);
    // The volume over the floor; the mean error that the solver may leave lets it stand lower by as much, and
    // the surface is uneven by less than half a spacing.
    const double volume = static_cast<double>(seen.particles) * kSpacing * kSpacing * kSpacing;
    EXPECT_NEAR(seen.level, volume / area, 0.5 * kSpacing);

    Scene one = scene;
    one.fluid = {scene.fluid[left ? 0 : 1]};
    Simulation alone(one, 1);
    advance(alone);
    const Side reference = sideOf(alone.view(), left);
    ASSERT_EQ(reference.particles, seen.particles);
    // The sides share one tolerance, so that each may be solved a little more or less than alone.
    EXPECT_NEAR(seen.error, reference.error, scene.solver.tolerance);
    EXPECT_NEAR(seen.level, reference.level, scene.solver.tolerance * reference.level);
  }
}

INSTANTIATE_TEST_SUITE_P(Thicknesses, Plates, ::testing::Values("plate_1", "plate_0.25", "plate_0.05"),
                         [](const auto& one) {
                           return std::string(one.param.substr(6) == "1"      ? "OfOneSupportRadius"
                                              : one.param.substr(6) == "0.25" ? "OfAQuarter"
                                                                              : "OfATwentieth");
                         });

}  // namespace plate_test
}  // namespace migiwa::testing
