// Distances from a grid against the shapes' own closed forms, and where points end up that move out.
#include <gtest/gtest.h>

#include "core/walls/gridded.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace gridded_surface_test {

constexpr float kSupport = 0.1F, kMargin = 0.25F * kSupport;

/// Points all over a cube, every other one on the faces of the grid's cells as closely as floats allow.
template <class Take>
void forPoints(float reach, const Take& take) {
  constexpr float kCell = kSupport / GriddedSurface::kCellsPerSupport;
  for (int k = 0; k < 60000; ++k) {
    const auto along = [&](double step) {
      const auto at = static_cast<float>(std::fmod(0.5 + step * k, 1.0));
      const float p = reach * (2 * at - 1);
      return k % 2 == 0 ? p : kCell * std::round(p / kCell);
    };
    take(Vec3f(along(0.8191725134), along(0.6710436067), along(0.5497004779)));
  }
}

struct Worst {
  float distance = 0, normal = 0, projected = 0;
};

/// Within 1.4 support radii in the fluid and half of one in the solid; in support radii.
Worst worstOf(const std::shared_ptr<const Surface>& shape) {
  ThreadPool pool(2);
  const GriddedSurface gridded(shape, kSupport, pool);
  Worst worst;
  forPoints(0.6F, [&](const Vec3f& p) {
    Vec3f exactNormal, normal;
    const float exact = shape->distance(p, exactNormal), distance = gridded.distance(p, normal);
    if (exact > 1.55F * kSupport) {
      EXPECT_GT(distance, 1.5F * kSupport) << p.transpose();
      return;
    }
    if (exact < -0.5F * kSupport) return;
    worst.distance = std::max(worst.distance, std::abs(distance - exact) / kSupport);
    if (exact > kMargin) worst.normal = std::max(worst.normal, (normal - exactNormal).norm());
    Vec3f moved = p;
    const bool did = gridded.project(moved, kMargin);
    EXPECT_EQ(did, moved != p);
    Vec3f ignored;
    worst.projected = std::max(worst.projected, (kMargin - shape->distance(moved, ignored)) / kSupport);
    EXPECT_FALSE(did && exact > 1.1F * kMargin) << p.transpose();
  });
  return worst;
}

TEST(GriddedSurface, IsWithinAThousandthOnSmoothWalls) {
  for (const Sphere::Fluid fluid : {Sphere::Fluid::inside, Sphere::Fluid::outside}) {
    const Worst worst = worstOf(std::make_shared<Sphere>(Vec3d(0.01, 0.02, -0.03), 0.35, fluid));
    EXPECT_LT(worst.distance, 0.001F);
    EXPECT_LT(worst.normal, 0.005F);
    EXPECT_LT(worst.projected, 0.001F);
  }
}

TEST(GriddedSurface, RoundsCreasesByAFiftieth) {
  const Rotation turned{{1, 2, 3}, 40};
  // Around a block the distance is smooth outside; in a tank it has creases where walls meet.
  const Worst block = worstOf(
      std::make_shared<Box>(Vec3d(-0.3, -0.25, -0.2), Vec3d(0.3, 0.25, 0.2), Box::Fluid::outside, turned));
  EXPECT_LT(block.projected, 0.025F);
  const Worst tank = worstOf(
      std::make_shared<Box>(Vec3d(-0.3, -0.25, -0.2), Vec3d(0.3, 0.25, 0.2), Box::Fluid::inside, turned));
  EXPECT_LT(tank.distance, 0.06F);
  EXPECT_LT(tank.projected, 0.025F);
}

TEST(GriddedSurface, OnlyStandsInForCostlyShapes) {
  ThreadPool pool(1);
  const std::shared_ptr<const Surface> sphere =
      std::make_shared<Sphere>(Vec3d::Zero(), 0.35, Sphere::Fluid::inside);
  EXPECT_EQ(withDistanceGrids({sphere}, kSupport, pool).front(), sphere);
  EXPECT_EQ(GriddedSurface(sphere, kSupport, pool).exact(), sphere);
}

}  // namespace gridded_surface_test
}  // namespace migiwa
