// The report's measures on lattices whose answer is known.
#include "core/simulation/measures.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"

namespace migiwa {
namespace measures_test {

using namespace migiwa::testing;

/// A tank of 8 x 20 x 6 cells; its lattice has `layers` layers.
Scene tankScene(const Rotation& rotation = {}) {
  Scene scene = emptyScene();
  scene.gravity = rotation.matrix() * Vec3d(0, -9.81, 0);
  addTank(scene, {0, 0, 0}, {0.4, 1, 0.3}, rotation);
  return scene;
}

std::vector<Float4> lattice(int layers, double stretch = 1) {
  std::vector<Float4> points;
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < layers; ++j)
      for (int i = 0; i < 8; ++i)
        points.emplace_back(
            Vec3d((i + 0.5) * kSpacing, (j + 0.5) * kSpacing * stretch, (k + 0.5) * kSpacing).cast<float>());
  return points;
}

SettledMeasures measure(const Scene& scene, const std::vector<Float4>& points, const Float4& velocity = {}) {
  SettledSampler sampler;
  sampler.sample(scene, points, std::vector<Float4>(points.size(), velocity));
  return sampler.result();
}

TEST(Measures, AnEvenFillingIsOneEverywhere) {
  const SettledMeasures found = measure(tankScene(), lattice(10), {0.3F, 0.4F, 0});
  EXPECT_NEAR(*found.height, 0.5, 1e-6);
  EXPECT_NEAR(*found.expectedHeight, 0.5, 1e-6);
  EXPECT_NEAR(*found.edgeCrowding, 1, 1e-6);
  EXPECT_NEAR(*found.nearWallSpacingP1, 1, 1e-5);
  EXPECT_NEAR(*found.bulkSpacingP1, 1, 1e-5);
  EXPECT_NEAR(*found.rmsSpeed, 0.5, 1e-6);
}

TEST(Measures, ACompressedLatticeIsLowAndClose) {
  const SettledMeasures found = measure(tankScene(), lattice(10, 0.9));
  EXPECT_NEAR(*found.height / *found.expectedHeight, 0.9, 1e-5);
  EXPECT_NEAR(*found.nearWallSpacingP1, 0.9, 1e-5);
  EXPECT_NEAR(*found.bulkSpacingP1, 0.9, 1e-5);
}

TEST(Measures, EdgeCrowdingCountsWhatIsInTheStrips) {
  std::vector<Float4> points = lattice(10);
  // 4 vertical edges of 10 and floor edges of 2 (6 + 4) cells hold 60 particles. Thirty more on one edge: 1.5
  // times, over a level that 30 particles raise by 30/48 of a layer.
  for (int k = 0; k < 30; ++k) points.emplace_back(0.02F, 0.1F + 0.01F * static_cast<float>(k), 0.01F);
  const double level = 10 + 30.0 / 48;
  EXPECT_NEAR(*measure(tankScene(), points).edgeCrowding, 90 / (4 * level + 20), 1e-5);
}

TEST(Measures, ATurnedTankUnderTurnedGravityMeasuresTheSame) {
  const Rotation turn{{1, 0.5, 2}, 50};
  const Vec3d center(0.2, 0.5, 0.15);
  std::vector<Float4> turned;
  for (const Float4& p : lattice(10, 0.95))
    turned.emplace_back((center + turn.matrix() * (p.xyz().cast<double>() - center)).cast<float>());
  const SettledMeasures straight = measure(tankScene(), lattice(10, 0.95));
  const SettledMeasures found = measure(tankScene(turn), turned);
  EXPECT_NEAR(*found.height, *straight.height, 1e-5);
  EXPECT_NEAR(*found.edgeCrowding, *straight.edgeCrowding, 1e-6);
  EXPECT_NEAR(*found.nearWallSpacingP1, *straight.nearWallSpacingP1, 1e-4);
}

TEST(Measures, WhatIsNotThereIsNull) {
  Scene tilted = tankScene();
  tilted.gravity = {3, -9, 0};
  EXPECT_FALSE(measure(tilted, lattice(4)).height);
  EXPECT_FALSE(measure(emptyScene(), lattice(4)).edgeCrowding);
  EXPECT_FALSE(measure(emptyScene(), lattice(4)).nearWallSpacingP1);
  EXPECT_TRUE(measure(emptyScene(), lattice(4)).bulkSpacingP1);
  EXPECT_FALSE(measure(tankScene(), {}).rmsSpeed);
}

TEST(Measures, FramesAreAveraged) {
  SettledSampler sampler;
  const Scene scene = tankScene();
  for (const int layers : {8, 12}) {
    const std::vector<Float4> points = lattice(layers);
    sampler.sample(scene, points,
                   std::vector<Float4>(points.size(), Float4(layers == 8 ? 0.0F : 2.0F, 0, 0)));
  }
  EXPECT_NEAR(*sampler.result().height, 0.5, 1e-6);
  EXPECT_NEAR(*sampler.result().rmsSpeed, std::sqrt(2.0), 1e-6);
}

}  // namespace measures_test
}  // namespace migiwa
