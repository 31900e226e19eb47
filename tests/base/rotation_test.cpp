#include <gtest/gtest.h>

#include "core/base/fields.h"

namespace migiwa {
namespace rotation_test {

TEST(Rotation, TurnsRightHanded) {
  // A quarter turn takes each axis to the next but one's negative, by the definition of right-handed.
  EXPECT_TRUE((Rotation{Vec3d::UnitZ(), 90}.matrix() * Vec3d::UnitX()).isApprox(Vec3d::UnitY()));
  EXPECT_TRUE((Rotation{Vec3d::UnitX(), 90}.matrix() * Vec3d::UnitY()).isApprox(Vec3d::UnitZ()));
  EXPECT_TRUE((Rotation{Vec3d::UnitY(), 90}.matrix() * Vec3d::UnitZ()).isApprox(Vec3d::UnitX()));
}

TEST(Rotation, TheLengthOfTheAxisDoesNotMatter) {
  const Rotation shortAxis{Vec3d(1, 2, 3), 40};
  const Rotation longAxis{Vec3d(100, 200, 300), 40};
  EXPECT_TRUE(shortAxis.matrix().isApprox(longAxis.matrix()));
  EXPECT_TRUE((shortAxis.matrix() * Vec3d(1, 2, 3)).isApprox(Vec3d(1, 2, 3)));
}

TEST(Rotation, NoAngleIsExactlyTheIdentity) {
  EXPECT_EQ((Rotation{Vec3d(1, 2, 3), 0}.matrix()), Eigen::Matrix3d::Identity());
}

}  // namespace rotation_test
}  // namespace migiwa
