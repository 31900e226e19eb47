#include "app/render/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace migiwa {

Vec3d cameraRight(const Camera& camera) {
  const Vec3d back = (camera.eye - camera.target).normalized();
  const Vec3d right = camera.up.normalized().cross(back);
  return right.norm() > 1e-6 ? right.normalized() : back.unitOrthogonal();
}

Projection makeProjection(const Camera& camera, int pictureWidth, int pictureHeight, const Rect& scene) {
  const Vec3d back = (camera.eye - camera.target).normalized();
  const Vec3d right = cameraRight(camera);
  const Vec3d up = back.cross(right);
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = up.transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * camera.eye;

  // Four decades of depth around what is looked at: enough for a close-up and for the ground's far end.
  const double distance = (camera.eye - camera.target).norm();
  const double near = 0.01 * distance, far = 100 * distance;

  const double sceneAspect = static_cast<double>(scene.width) / scene.height;
  const double pictureAspect = static_cast<double>(pictureWidth) / pictureHeight;
  const double tangent =
      std::tan(camera.fovDegrees * std::numbers::pi / 360) * std::max(1.0, pictureAspect / sceneAspect);
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 1 / (tangent * sceneAspect);
  clip(1, 1) = 1 / tangent;
  clip(2, 2) = -(far + near) / (far - near);
  clip(2, 3) = -2 * far * near / (far - near);
  clip(3, 2) = -1;
  return {view.cast<float>(), clip.cast<float>(), near, far};
}

std::optional<std::array<float, 2>> pixelOf(const Vec3f& place, const Projection& projection,
                                            const Rect& scene) {
  const Eigen::Vector4f clip =
      projection.clip * (projection.view * Eigen::Vector4f(place.x(), place.y(), place.z(), 1));
  if (!(clip.w() > static_cast<float>(projection.near))) return std::nullopt;
  return {
      {static_cast<float>(scene.x) + 0.5F * (1 + clip.x() / clip.w()) * static_cast<float>(scene.width),
       static_cast<float>(scene.y) + 0.5F * (1 - clip.y() / clip.w()) * static_cast<float>(scene.height)}};
}

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
