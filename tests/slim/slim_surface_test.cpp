// SLIM surfaces as walls: rays, projection and pieces against exact shapes, and gamma through the methods
// that scenes use against exact quadrature.
#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/slim/model.h"
#include "core/walls/boundary.h"
#include "core/walls/slim_wall.h"
#include "tests/gamma/gamma_reference.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace slim_surface_test {

using testing::ExactSphere;

constexpr float kSupport = 0.25F;  // a quarter of the sphere's radius

std::shared_ptr<const SlimWallData> fittedSphere(int degree, double radiusOverSupport) {
  ThreadPool pool(2);
  SlimFitOptions options;
  options.degree = degree;
  options.radius = radiusOverSupport * static_cast<double>(kSupport);
  auto data = std::make_shared<SlimWallData>();
  data->model = std::make_unique<const SlimModel>(fitSlim(ExactSphere{}.points(60000), options, pool), degree,
                                                  true, pool);
  return data;
}

int methodIndex(std::string_view name) {
  const auto names = gammaMethodNames();
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Largest error of gamma over points at the given distances from the wall (in support radii).
double worstGamma(const SlimSurface& surface, bool inside, std::string_view method,
                  std::initializer_list<double> distances) {
  const Boundary boundary({std::make_shared<SlimSurface>(surface)});
  GammaContext context{boundary, KernelType::poly6, kSupport};
  context.directions = 1024;
  const PickedGamma gamma = makeGammaMethod(methodIndex(method), context);
  double worst = 0;
  for (const double e : distances) {
    const double offset = 1 + (inside ? -e : e) * static_cast<double>(kSupport);
    const double within = reference::insideSphere(KernelType::poly6, offset / static_cast<double>(kSupport),
                                                  1 / static_cast<double>(kSupport));
    const double exact = inside ? within : 1 - within;
    for (const OrientedPoint& at : ExactSphere{}.points(60).points) {
      const Float4 point(static_cast<float>(offset) * at.normal);
      GammaSample sample;
      gamma.method->evaluate({&point, 1}, {&sample, 1});
      worst = std::max(worst, std::abs(static_cast<double>(sample.gamma) - exact));
    }
  }
  return worst;
}

TEST(SlimGamma, DirectionsAreWithinAHundredthInsideAndOutside) {
  for (int degree = 1; degree <= 3; ++degree) {
    const auto data = fittedSphere(degree, degree == 1 ? 0.25 : 0.5);
    for (const bool inside : {true, false}) {
      const SlimSurface surface(data, inside ? SlimSurface::Fluid::inside : SlimSurface::Fluid::outside);
      const double error = worstGamma(surface, inside, "directions", {0.1, 0.25, 0.5, 0.75, 0.95});
      std::printf("degree %d, fluid %s: directions %.4f, mean %.4f\n", degree, inside ? "inside" : "outside",
                  error, worstGamma(surface, inside, "mean", {0.1, 0.25, 0.5, 0.75, 0.95}));
      EXPECT_LT(error, 0.01) << "degree " << degree << (inside ? " inside" : " outside");
    }
  }
}

TEST(SlimGamma, TheMeanIsAsFarOffAsEquation14Is) {
  // METHOD: 0.04 to 0.10 in bowls. On a surface of curvature radius 4 h Eq. 14 sees planes, and weighs them
  // by their centres.
  const SlimSurface surface(fittedSphere(1, 0.25), SlimSurface::Fluid::inside);
  const double error = worstGamma(surface, true, "mean", {0.25, 0.5});
  EXPECT_GT(error, 0.01);
  EXPECT_LT(error, 0.15);
}

TEST(SlimRays, PassASphereWhereTheExactOneIs) {
  const Directions directions = fibonacciDirections(256);
  for (int degree = 1; degree <= 3; ++degree) {
    const auto data = fittedSphere(degree, degree == 1 ? 0.25 : 0.6);
    std::vector<SlimPassages> found(directions.size());
    for (const double offset : {0.8, 0.95, 1.06, 1.2}) {
      long far = 0;
      for (const OrientedPoint& at : ExactSphere{}.points(40).points) {
        const Vec3d origin = offset * at.normal.cast<double>();
        slimPassages(*data->model, origin.cast<float>(), offset < 1,
                     {directions.x, directions.y, directions.z}, kSupport, found);
        for (std::size_t k = 0; k < directions.size(); ++k) {
          const Vec3d w(directions.x[k], directions.y[k], directions.z[k]);
          const double b = origin.dot(w), c = origin.squaredNorm() - 1, square = b * b - c;
          const auto reach = static_cast<double>(kSupport);
          double first = reach;
          if (offset < 1) first = std::min(first, std::sqrt(square) - b);
          if (offset > 1 && square > 0 && b < 0) first = std::min(first, -b - std::sqrt(square));
          // A ray that grazes may pass or miss: the passage is then as uncertain as its length is sensitive.
          const double error = std::abs(std::min(static_cast<double>(found[k][0]), reach) - first);
          if (error > 0.02 * reach) ++far;
        }
      }
      EXPECT_LE(far, 10) << "of 10240 rays, degree " << degree << ", offset " << offset;
    }
  }
}

TEST(SlimRays, ThinPlateLetsRaysOutAgain) {
  // A flat ball, 0.1 thick: points above and below, far thinner than they are wide.
  OrientedPoints points;
  for (int i = -100; i <= 100; ++i)
    for (int j = -100; j <= 100; ++j)
      for (const float side : {-1.0F, 1.0F})
        points.points.push_back({{0.01F * static_cast<float>(i), 0.05F * side, 0.01F * static_cast<float>(j)},
                                 side * Vec3f::UnitY()});
  ThreadPool pool(1);
  SlimFitOptions options;
  options.degree = 1;
  options.tolerance = 0.001;
  const SlimModel model(fitSlim(points, options, pool), 1, true, pool);
  const float x[] = {0, 0}, y[] = {-1, 1}, z[] = {0, 0};
  std::vector<SlimPassages> found(2);
  slimPassages(model, {0.1F, 0.15F, -0.2F}, false, {x, y, z}, 1, found);
  EXPECT_NEAR(found[0][0], 0.1, 1e-4);
  EXPECT_NEAR(found[0][1], 0.2, 1e-4);
  EXPECT_EQ(found[1][0], std::numeric_limits<float>::infinity());
  // A particle that would jump through it is stopped at the near side.
  float at = 0;
  Vec3f normal;
  ASSERT_TRUE(slimFirstPassage(model, {0, 0.25F, 0}, {0.02F, -0.15F, 0}, false, at, normal));
  EXPECT_NEAR(at, 0.5, 1e-3);
  EXPECT_NEAR(normal.y(), 1, 1e-3);
  EXPECT_FALSE(slimFirstPassage(model, {0, 0.25F, 0}, {0.5F, 0.1F, 0}, false, at, normal));
}

TEST(SlimRays, ThicknessIsTheLeastWayThroughTheSolid) {
  ThreadPool pool(2);
  SlimFitOptions options;
  options.degree = 2;
  options.tolerance = 0.002;
  const SlimModel torus(fitSlim(testing::ExactTorus{}.points(30000), options, pool), 2, true, pool);
  EXPECT_NEAR(slimThickness(torus), 0.8, 0.02);
  const SlimModel bowl(fitSlim(bowlPoints({Vec3d::Zero(), 1, 0.15}, 60000), options, pool), 2, true, pool);
  EXPECT_NEAR(slimThickness(bowl), 0.15, 0.01);
}

TEST(SlimSurface, ProjectionEndsAtTheMargin) {
  const auto data = fittedSphere(2, 0.5);
  constexpr float kMargin = 0.06F;
  for (const bool inside : {true, false}) {
    const SlimSurface surface(data, inside ? SlimSurface::Fluid::inside : SlimSurface::Fluid::outside);
    for (const OrientedPoint& at : ExactSphere{}.points(100).points) {
      for (const float radius : {0.3F, 0.93F, 0.99F, 1.01F, 1.05F, 1.5F}) {
        Vec3f p = radius * at.normal;
        const float exact = inside ? 1 - radius : radius - 1;
        const bool moved = surface.project(p, kMargin);
        EXPECT_EQ(moved, exact < kMargin);
        const float expected = inside ? 1 - kMargin : 1 + kMargin;
        // From far behind the wall, the first and longest move goes by the coarse grid.
        const float error = exact < -0.3F ? 0.01F : 0.001F;
        EXPECT_NEAR(p.norm(), moved ? expected : radius, error) << radius;
      }
    }
  }
}

TEST(SlimSurface, PiecesAreTheNodesInReach) {
  const auto data = fittedSphere(1, 0.25);
  const SlimSurface surface(data, SlimSurface::Fluid::inside);
  const Vec3f p(0, 0.9F, 0);
  std::vector<WallPiece> pieces;
  surface.pieces(p, kSupport, pieces);
  std::size_t expected = 0;
  for (const SlimNode& node : data->model->nodes())
    if ((node.centre - p).norm() < kSupport) ++expected;
  EXPECT_EQ(pieces.size(), expected);
  EXPECT_GT(expected, 50U);
  for (const WallPiece& piece : pieces) {
    EXPECT_LT(piece.normal.dot(piece.foot), -0.99F) << "into the fluid";
    EXPECT_NEAR(piece.planeDistance, piece.normal.dot(p - piece.foot), 0.01F);
  }
}

}  // namespace slim_surface_test
}  // namespace migiwa
