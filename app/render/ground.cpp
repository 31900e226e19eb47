#include "app/render/ground.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace migiwa {
namespace {

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
double roundDown125(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const double digits = value / power;
  return (digits >= 5 ? 5 : digits >= 2 ? 2 : 1) * power;
}

}  // namespace

Ground makeGround(const Bounds& scene, const Vec3d& up) {
  Ground ground;
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  ground.up = Vec3d::Unit(axis) * (up[axis] < 0 ? -1 : 1);
  ground.u = Vec3d::Unit((axis + 1) % 3);
  ground.v = ground.up.cross(ground.u);
  if (!scene.empty()) {
    ground.extent = std::max(scene.size().maxCoeff(), 1e-3);
    ground.center = scene.center();
    ground.center[axis] = up[axis] < 0 ? scene.max[axis] : scene.min[axis];
  }
  ground.halfSide = 3 * ground.extent;
  ground.gridSpacing = roundDown125(ground.extent / 8);
  return ground;
}

}  // namespace migiwa
