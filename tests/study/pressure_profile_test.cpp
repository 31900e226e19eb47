// Profiles of pressures made by hand.
#include <cmath>

#include <gtest/gtest.h>

#include "core/study/study.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace pressure_profile_test {

using namespace migiwa::testing;

constexpr double kPerMetre = 1000 * 9.81;  // rho0 g (Pa/m)
constexpr int kCells = 8, kLayers = 10;

/// A lattice at rest in its tank, each particle with the pressure that `of` gives for its depth (m).
template <class Of>
PressureProfile profile(const Scene& scene, const Of& of) {
  std::vector<Float4> positions;
  std::vector<float> pressures;
  for (int layer = 0; layer < kLayers; ++layer) {
    for (int i = 0; i < kCells * kCells; ++i) {
      const Vec3d at = kSpacing * Vec3d(i % kCells + 0.5, kLayers - layer - 0.5, i / kCells + 0.5);
      positions.emplace_back(Vec3f(at.cast<float>()));
      pressures.push_back(static_cast<float>(of(kSpacing * (layer + 0.5))));
    }
  }
  PressureProfile result;
  result.sample(scene, positions, pressures);
  return result;
}

TEST(PressureProfile, OfHydrostaticPressureHasNoError) {
  const PressureProfile found =
      profile(stillTank({kCells, kLayers, kCells}), [](double depth) { return kPerMetre * depth; });
  EXPECT_NEAR(*found.error(), 0, 1e-5);
  const std::vector<PressureLayer> layers = found.layers();
  ASSERT_EQ(layers.size(), static_cast<std::size_t>(kLayers));
  EXPECT_NEAR(layers[3].depth, 3.5 * kSpacing, 1e-5);
  EXPECT_DOUBLE_EQ(layers[3].particles, kCells * kCells);
}

TEST(PressureProfile, ErrorIsOverThePressureAtTheFloor) {
  const Scene scene = stillTank({kCells, kLayers, kCells});
  const double floor = kPerMetre * kLayers * kSpacing;
  EXPECT_NEAR(*profile(scene, [&](double depth) { return kPerMetre * depth + 0.2 * floor; }).error(), 0.2,
              1e-5);
  // A slope that is a tenth too steep errs by a tenth of the depth: rms of (k + 1/2) / N over the layers.
  double squares = 0;
  for (int k = 0; k < kLayers; ++k) squares += (k + 0.5) * (k + 0.5);
  const double rms = std::sqrt(squares / kLayers) / kLayers;
  EXPECT_NEAR(*profile(scene, [](double depth) { return 1.1 * kPerMetre * depth; }).error(), 0.1 * rms, 1e-5);
}

TEST(PressureProfile, IsNoneWithoutATankOrAWatch) {
  Scene scene = stillTank({kCells, kLayers, kCells});
  scene.surfaces.clear();
  EXPECT_FALSE(profile(scene, [](double) { return 1; }).error());
  Simulation simulation(stillTank({4, 4, 4}), 1);
  simulation.advanceFrame();
  PressureProfile unwatched;
  unwatched.sample(simulation);
  EXPECT_FALSE(unwatched.error());
}

}  // namespace pressure_profile_test
}  // namespace migiwa
