#include "core/scene/default_camera.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace migiwa {

Camera defaultCamera(const Bounds& bounds, const Vec3d& gravity) {
  Camera camera;
  if (gravity.norm() > 0) camera.up = Vec3d::Zero() - gravity.normalized();  // 0 - 0 has no sign to show
  // The front is +z as long as that is level, else -y.
  const Vec3d level = std::abs(camera.up.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d(-Vec3d::UnitY());
  const Vec3d front = (level - level.dot(camera.up) * camera.up).normalized();
  const Vec3d right = camera.up.cross(front);
  const Vec3d towardsEye = (front + 0.35 * right + 0.4 * camera.up).normalized();
  const double radius = bounds.empty() ? 1 : std::max(0.5 * bounds.size().norm(), 1e-6);
  camera.target = bounds.empty() ? Vec3d(Vec3d::Zero()) : bounds.center();
  camera.eye =
      camera.target + radius / std::sin(0.5 * camera.fovDegrees * std::numbers::pi / 180) * towardsEye;
  return camera;
}

}  // namespace migiwa
