#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/scene/scene.h"

namespace migiwa {
namespace default_camera_test {

/// The largest angle (degrees) between the line of sight and a corner of the bounds.
double widestAngle(const Camera& camera, const Bounds& bounds) {
  double widest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p((corner & 1) != 0 ? bounds.max.x() : bounds.min.x(),
                  (corner & 2) != 0 ? bounds.max.y() : bounds.min.y(),
                  (corner & 4) != 0 ? bounds.max.z() : bounds.min.z());
    const double cosine = (p - camera.eye).normalized().dot((camera.target - camera.eye).normalized());
    widest = std::max(widest, std::acos(cosine) * 180 / std::numbers::pi);
  }
  return widest;
}

TEST(DefaultCamera, SeesEveryCornerAndNotFromTooFar) {
  for (const Vec3d& size :
       {Vec3d(3.2, 2, 1.6), Vec3d(0.01, 0.01, 0.01), Vec3d(100, 1, 1), Vec3d(1, 1, 500)}) {
    Bounds bounds;
    bounds.include(Vec3d(7, -3, 2));
    bounds.include(Vec3d(Vec3d(7, -3, 2) + size));
    const Camera camera = defaultCamera(bounds, {0, -9.81, 0});
    const double widest = widestAngle(camera, bounds);
    EXPECT_LE(widest, 0.5 * camera.fovDegrees + 1e-9);
    EXPECT_GE((camera.eye - camera.target).norm(), 0.5 * size.norm());
    EXPECT_LE((camera.eye - camera.target).norm(), 2 * size.norm());
    EXPECT_GT(camera.eye.y(), camera.target.y());
    EXPECT_GT(camera.eye.z(), camera.target.z());
  }
}

TEST(DefaultCamera, UpIsAgainstGravity) {
  Bounds bounds;
  bounds.include(Vec3d(0, 0, 0));
  bounds.include(Vec3d(1, 2, 3));
  for (const Vec3d& down :
       {Vec3d(0, 0, -9.81), Vec3d(0, 0, 9.81), Vec3d(-1, 0, 0), Vec3d(1, 1, 1), Vec3d(0, -1, 0)}) {
    const Camera camera = defaultCamera(bounds, down);
    EXPECT_TRUE(camera.up.isApprox(-down.normalized()));
    EXPECT_GT((camera.eye - camera.target).dot(camera.up), 0) << "looks from above";
    EXPECT_GT((camera.eye - camera.target).cross(camera.up).norm(), 0.1);
  }
  EXPECT_TRUE(defaultCamera(bounds, Vec3d::Zero()).up.isApprox(Vec3d::UnitY()));
}

TEST(DefaultCamera, IsFiniteForAnEmptyScene) {
  const Camera camera = defaultCamera({}, {0, -9.81, 0});
  EXPECT_TRUE(camera.eye.allFinite());
  EXPECT_TRUE(camera.target.allFinite());
  EXPECT_GT((camera.eye - camera.target).norm(), 0);
}

}  // namespace default_camera_test
}  // namespace migiwa
