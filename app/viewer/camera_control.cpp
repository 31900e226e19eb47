#include "app/viewer/camera_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "app/render/projection.h"

namespace migiwa {
namespace {

constexpr double kClosest = 1e-3, kFarthest = 1e5;
constexpr double kPole = 0.03;  ///< how near the view may come to the up axis

}  // namespace

void orbit(Camera& camera, double right, double up) {
  const Vec3d axis = camera.up.normalized();
  const Vec3d arm = Eigen::AngleAxisd(-right, axis) * (camera.eye - camera.target);
  const double polar = std::acos(std::clamp(arm.normalized().dot(axis), -1.0, 1.0));
  const double wanted = std::clamp(polar - up, kPole, std::numbers::pi - kPole);
  camera.eye = camera.target + arm;
  camera.eye = camera.target + Eigen::AngleAxisd(wanted - polar, cameraRight(camera)) * arm;
}

void pan(Camera& camera, double right, double up) {
  const Vec3d back = (camera.eye - camera.target).normalized();
  const Vec3d side = cameraRight(camera);
  const Vec3d shift = -right * side - up * back.cross(side);
  camera.eye += shift;
  camera.target += shift;
}

void zoom(Camera& camera, double factor) {
  const Vec3d arm = camera.eye - camera.target;
  const double distance = std::clamp(arm.norm() * factor, kClosest, kFarthest);
  camera.eye = camera.target + arm.normalized() * distance;
}

void lookAt(Camera& camera, const Vec3d& point) {
  if ((camera.eye - point).norm() > kClosest) camera.target = point;
}

}  // namespace migiwa
