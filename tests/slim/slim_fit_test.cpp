// The fit against shapes known exactly: its error falls with the size of the balls as its degree says, keeps
// the tolerance, covers every point, and does not depend on threads.
#include <gtest/gtest.h>

#include "core/slim/fit.h"
#include "core/slim/model.h"
#include "tests/slim/error_orders.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace slim_fit_test {

using testing::ExactSphere;
using testing::ExactTorus;

class ErrorOrder : public ::testing::TestWithParam<int> {};

TEST_P(ErrorOrder, OfTheDistanceIsOneMoreThanTheDegreeAndOfTheNormalTheDegree) {
  const int degree = GetParam();
  ThreadPool pool(2);
  for (const testing::OrderShape& shape : testing::orderShapes()) {
    std::vector<testing::OrderPoint> points;
    for (const double share : {1.0, 0.5})
      points.push_back(testing::errorsAt(shape, degree, share * shape.radius, pool));
    const double distance = testing::orderOf(points, &testing::OrderPoint::distance);
    const double normal = testing::orderOf(points, &testing::OrderPoint::normal);
    std::printf("%s, degree %d: distance %.3g, %.3g m, order %.2f; normal %.3g, %.3g rad, order %.2f\n",
                shape.name.c_str(), degree, points[0].distance, points[1].distance, distance,
                points[0].normal, points[1].normal, normal);
    EXPECT_NEAR(distance, testing::expectedOrder(shape, degree), 0.4) << shape.name;
    EXPECT_NEAR(normal, testing::expectedOrder(shape, degree) - 1, 0.4) << shape.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, ErrorOrder, ::testing::Values(1, 2, 3));

TEST(SlimFit, KeepsTheToleranceAndCoversEveryPoint) {
  ThreadPool pool(2);
  const OrientedPoints points = ExactTorus{}.points(30000);
  for (int degree = 1; degree <= 3; ++degree) {
    SlimFitOptions options;
    options.degree = degree;
    options.tolerance = 0.004;
    const std::vector<SlimNode> nodes = fitSlim(points, options, pool);
    for (const SlimNode& node : nodes) ASSERT_LE(node.error, 0.004F);
    const SlimModel model(nodes, degree, true, pool);
    for (const OrientedPoint& point : points.points) {
      const SlimModel::Value value = model.evaluate(point.position);
      ASSERT_GE(value.weight, 0.088F) << "the weight at the rim of a core";
      ASSERT_LT(std::abs(value.f), 1.5F * 0.004F);
    }
  }
}

TEST(SlimFit, HigherDegreesNeedFewerNodes) {
  ThreadPool pool(2);
  const OrientedPoints points = ExactTorus{}.points(30000);
  std::size_t last = 1000000;
  for (int degree = 1; degree <= 3; ++degree) {
    SlimFitOptions options;
    options.degree = degree;
    options.tolerance = 0.002;
    const std::size_t count = fitSlim(points, options, pool).size();
    EXPECT_LT(count, 0.8 * static_cast<double>(last)) << "degree " << degree;
    last = count;
  }
}

TEST(SlimFit, ComesNearTheNumberOfNodesAskedFor) {
  ThreadPool pool(2);
  const OrientedPoints points = bowlPoints({}, 40000);
  SlimFitOptions options;
  options.degree = 1;
  options.nodes = 1000;
  EXPECT_NEAR(static_cast<double>(fitSlim(points, options, pool).size()), 1000, 60);
}

TEST(SlimFit, IsTheSameForAnyNumberOfThreads) {
  const OrientedPoints points = ExactSphere{}.points(5000);
  SlimFitOptions options;
  options.degree = 2;
  options.tolerance = 0.005;
  ThreadPool one(1), four(4);
  const std::vector<SlimNode> a = fitSlim(points, options, one), b = fitSlim(points, options, four);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].centre, b[k].centre);
    ASSERT_EQ(a[k].radius, b[k].radius);
    ASSERT_EQ(a[k].coefficients, b[k].coefficients);
  }
}

TEST(SlimFit, OfAPlaneIsThePlane) {
  OrientedPoints points;
  points.closed = false;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      points.points.push_back(
          {{0.01F * static_cast<float>(i), 0.2F, 0.01F * static_cast<float>(j)}, Vec3f::UnitY()});
  ThreadPool pool(1);
  for (int degree = 1; degree <= 3; ++degree) {
    SlimFitOptions options;
    options.degree = degree;
    options.tolerance = 1e-3;
    const SlimModel model(fitSlim(points, options, pool), degree, false, pool);
    const SlimModel::Nearest above = model.nearest({0.31F, 0.23F, 0.28F});
    EXPECT_NEAR(above.distance, 0.03, 1e-5);
    EXPECT_NEAR(above.normal.y(), 1, 1e-5);
    EXPECT_NEAR(model.nearest({0.31F, 0.17F, 0.28F}).distance, -0.03, 1e-5);
  }
}

}  // namespace slim_fit_test
}  // namespace migiwa
