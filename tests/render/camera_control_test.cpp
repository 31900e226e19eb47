#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "app/render/projection.h"

namespace migiwa {
namespace camera_control_test {

Camera camera() {
  return {Vec3d(0, 0, 5), Vec3d(0, 0, 0), Vec3d(0, 1, 0), 40};
}

TEST(CameraControlTest, OrbitKeepsTheDistance) {
  Camera c = camera();
  orbit(c, 0.7, 0.4);
  EXPECT_NEAR((c.eye - c.target).norm(), 5, 1e-12);
  EXPECT_EQ(c.target, Vec3d(0, 0, 0));
}

TEST(CameraControlTest, QuarterOrbitToTheRightLooksFromTheLeft) {
  Camera c = camera();
  orbit(c, std::numbers::pi / 2, 0);
  EXPECT_NEAR((c.eye - Vec3d(-5, 0, 0)).norm(), 0, 1e-12) << c.eye.transpose();
}

TEST(CameraControlTest, DraggingDownLooksFromAboveButNeverOverThePole) {
  Camera c = camera();
  orbit(c, 0, 0.5);
  EXPECT_NEAR(c.eye.y(), 5 * std::sin(0.5), 1e-12);
  orbit(c, 0, 10);
  EXPECT_GT(c.eye.y(), 4.9);
  EXPECT_GT(c.eye.z(), 0);
}

TEST(CameraControlTest, PanMovesEyeAndTargetAlike) {
  Camera c = camera();
  pan(c, 1, 2);
  EXPECT_NEAR((c.target - Vec3d(-1, -2, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((c.eye - Vec3d(-1, -2, 5)).norm(), 0, 1e-12);
}

TEST(CameraControlTest, ZoomStopsBeforeTheTarget) {
  Camera c = camera();
  zoom(c, 0.5);
  EXPECT_NEAR((c.eye - c.target).norm(), 2.5, 1e-12);
  for (int i = 0; i < 100; ++i) zoom(c, 0.5);
  EXPECT_GT((c.eye - c.target).norm(), 0);
}

}  // namespace camera_control_test
}  // namespace migiwa
