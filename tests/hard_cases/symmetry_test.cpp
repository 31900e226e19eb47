// Turned and mirrored copies of a dam break go the same way: no axis is preferred.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/hard_cases/hard_case.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace symmetry_test {

constexpr double kUntil = 0.25;  // before the front meets the far wall: nothing is chaotic yet
const Vec3d kTank{0.9, 0.8, 0.3}, kColumn{0.3, 0.4, 0.3};

/// Centre of mass and energy over the mass, in the frame of the tank.
struct Course {
  Vec3d center = Vec3d::Zero();
  double speed = 0;  ///< rms (m/s)
  double front = 0;  ///< mean of the farthest tenth along the tank (m)
};

Course courseOf(const Scene& scene, const Eigen::Matrix3d& toTank, const Vec3d& middle) {
  const FrameSnapshot end = observe(scene, kUntil).end;
  Course course;
  std::vector<double> along;
  for (std::size_t i = 0; i < end.positions.size(); ++i) {
    const Vec3d x = toTank * (end.positions[i].xyz().cast<double>() - middle) + 0.5 * kTank;
    course.center += x;
    course.speed += end.velocities[i].xyz().cast<double>().squaredNorm();
    along.push_back(x.x());
  }
  const auto n = static_cast<double>(end.positions.size());
  course.center /= n;
  course.speed = std::sqrt(course.speed / n);
  std::sort(along.rbegin(), along.rend());
  for (std::size_t k = 0; k < along.size() / 10; ++k) course.front += along[k];
  course.front /= static_cast<double>(along.size() / 10);
  return course;
}

Scene upright() {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addViscosity(scene);
  addFluid(scene, Vec3d::Zero(), kColumn);
  addTank(scene, Vec3d::Zero(), kTank);
  return scene;
}

Scene turned(const Rotation& rotation) {
  Scene scene = emptyScene();
  const Eigen::Matrix3d turn = rotation.matrix();
  scene.gravity = turn * Vec3d(0, -9.81, 0);
  addViscosity(scene);
  // A source turns about its own centre, which moves with the tank's.
  const Vec3d center = 0.5 * kTank + turn * (0.5 * kColumn - 0.5 * kTank);
  auto source = std::make_shared<BoxSource>(center - 0.5 * kColumn, center + 0.5 * kColumn, rotation);
  scene.fluid.push_back(source);
  addTank(scene, Vec3d::Zero(), kTank, rotation);
  return scene;
}

void expectSame(const Course& course, const Course& reference) {
  // Sums in another order differ by rounding, which the fluid multiplies: a twentieth of a spacing in the
  // mean.
  EXPECT_LT((course.center - reference.center).norm(), 0.05 * kSpacing);
  EXPECT_NEAR(course.front, reference.front, 0.2 * kSpacing);
  EXPECT_NEAR(course.speed, reference.speed, 0.03 * reference.speed);
}

TEST(Symmetry, TurnedTanksGoTheSameWay) {
  const Course reference = courseOf(upright(), Eigen::Matrix3d::Identity(), 0.5 * kTank);
  ASSERT_GT(reference.front, 0.45) << "it must have fallen over";
  for (const double degrees : {90.0, 180.0, 17.0, 45.0, 133.0}) {
    for (const Vec3d& axis : {Vec3d(0, 0, 1), Vec3d(0, 1, 0), Vec3d(1, 2, 3)}) {
      SCOPED_TRACE(::testing::Message() << degrees << " degrees about " << axis.transpose());
      Rotation rotation;
      rotation.axis = axis, rotation.degrees = degrees;
      expectSame(courseOf(turned(rotation), rotation.matrix().transpose(), 0.5 * kTank), reference);
    }
  }
}

TEST(Symmetry, AMirroredTankGoesTheMirroredWay) {
  const Course reference = courseOf(upright(), Eigen::Matrix3d::Identity(), 0.5 * kTank);
  Scene mirrored = upright();
  mirrored.fluid.clear();
  addFluid(mirrored, {kTank.x() - kColumn.x(), 0, 0}, {kTank.x(), kColumn.y(), kColumn.z()});
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(0, 0) = -1;
  expectSame(courseOf(mirrored, mirror, 0.5 * kTank), reference);
}

}  // namespace symmetry_test
}  // namespace migiwa::testing
