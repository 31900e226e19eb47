#include "core/simulation/upright_tank.h"

#include <cmath>

namespace migiwa {

std::optional<UprightTank> uprightTank(const Scene& scene) {
  if (scene.gravity.norm() <= 0 || scene.surfaces.size() != 1 || scene.surfaces.front()->motion)
    return std::nullopt;
  const BoxGeometry* box = scene.surfaces.front()->tank();
  if (box == nullptr) return std::nullopt;
  int axis = 0;
  const Vec3d along = box->axes.transpose() * -scene.gravity.normalized();
  if (along.cwiseAbs().maxCoeff(&axis) < 0.9999) return std::nullopt;
  const int first = (axis + 2) % 3, second = (axis + 1) % 3;
  UprightTank tank;
  tank.center = box->center;
  tank.axes << box->axes.col(first), std::copysign(1.0, along[axis]) * box->axes.col(axis),
      box->axes.col(second);
  tank.half = {box->halfExtents[first], box->halfExtents[axis], box->halfExtents[second]};
  return tank;
}

}  // namespace migiwa
