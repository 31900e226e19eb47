// Memory of a simulation's arrays that outlasts a step and the simulation; walls that are asked without one.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <migiwa/gamma.h>
#include <migiwa/scene.h>
#include <migiwa/simulation.h>
#include <migiwa/version.h>

namespace migiwa {
namespace detach_test {

Scene tank() {
  return parseScene(R"({ "format": 1, "particle_spacing": 0.1,
      "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 1] } ] } })",
                    "tank.json");
}

TEST(Detach, WhatIsHeldStaysAndTheRunGoesOnAsEver) {
  Simulation plain(tank(), 1), held(tank(), 1);
  std::vector<std::shared_ptr<const void>> kept;
  for (int frame = 0; frame < 20; ++frame) {
    const FrameView before = held.view();
    const std::span<const Float4> positions = before.positions;
    const std::vector<Float4> copy(positions.begin(), positions.end());
    for (const FrameArray array :
         {FrameArray::positions, FrameArray::velocities, FrameArray::density, FrameArray::gamma,
          FrameArray::lambda, FrameArray::pressure, FrameArray::ids})
      kept.push_back(held.detach(array));
    EXPECT_NE(held.view().positions.data(), positions.data());
    plain.advanceFrame();
    held.advanceFrame();
    ASSERT_EQ(std::memcmp(positions.data(), copy.data(), copy.size() * sizeof(Float4)), 0) << frame;
  }
  EXPECT_EQ(held.stateHash(), plain.stateHash());
}

TEST(WallQuery, KnowsHalfAQuarterAndAnEighth) {
  WallQuery query(tank(), 1);
  const std::vector<Vec3d> points{{0.5, 0.5, 0.5}, {0.5, 0, 0.5}, {0, 0, 0.5}, {0, 0, 0}};
  const std::vector<WallAnswer> answers = query.answers(points);
  const double known[] = {1, 0.5, 0.25, 0.125};
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_NEAR(answers[k].gamma, known[k], 1e-3) << k;
  EXPECT_NEAR(answers[0].distance, 0.5, 1e-6);
  const std::vector<Vec3d> normals = query.normals(points);
  EXPECT_NEAR((normals[1] - Vec3d::UnitY()).norm(), 0, 1e-6);
}

TEST(WallQuery, WithoutWallsNothingIsNear) {
  WallQuery query(parseScene(R"({ "format": 1, "particle_spacing": 0.1 })", "open.json"), 1);
  const std::vector<Vec3d> points{{1, 2, 3}};
  EXPECT_EQ(query.answers(points).front().gamma, 1);
  EXPECT_TRUE(std::isinf(query.answers(points).front().distance));
}

TEST(Version, IsThatOfItsParts) {
  EXPECT_EQ(std::string(MIGIWA_VERSION), std::to_string(MIGIWA_VERSION_MAJOR) + "." +
                                             std::to_string(MIGIWA_VERSION_MINOR) + "." +
                                             std::to_string(MIGIWA_VERSION_PATCH));
}

}  // namespace detach_test
}  // namespace migiwa
