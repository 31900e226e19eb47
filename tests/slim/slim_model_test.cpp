// Distances, normals and gradients of SLIM surfaces against exact shapes, near and far.
#include <algorithm>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/slim/fit.h"
#include "core/slim/model.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace slim_model_test {

using testing::ExactSphere;
using testing::ExactTorus;

std::unique_ptr<SlimModel> fitted(const OrientedPoints& points, int degree, double tolerance) {
  ThreadPool pool(2);
  SlimFitOptions options;
  options.degree = degree;
  options.tolerance = tolerance;
  return std::make_unique<SlimModel>(fitSlim(points, options, pool), degree, points.closed, pool);
}

/// Largest errors of distance (m) and normal (rad) over points at `offset` from the surface.
template <class Shape>
void expectNear(const SlimModel& model, const Shape& shape, const OrientedPoints& points, double offset,
                double distanceError, double normalError) {
  for (const OrientedPoint& point : points.points) {
    const Vec3d p = point.position.cast<double>() + offset * point.normal.cast<double>();
    Vec3d normal;
    const double exact = shape(p, normal);
    const SlimModel::Nearest found = model.nearest(p.cast<float>());
    ASSERT_NEAR(static_cast<double>(found.distance), exact, distanceError)
        << "at " << p.transpose() << " offset " << offset;
    const double cosine = found.normal.cast<double>().dot(normal);
    ASSERT_GT(cosine, std::cos(normalError)) << "at " << p.transpose() << " offset " << offset;
  }
}

TEST(SlimModel, DistanceAndNormalOfATorus) {
  const ExactTorus torus;
  const auto shape = [&](const Vec3d& p, Vec3d& n) { return torus.distance(p, n); };
  const OrientedPoints points = torus.points(40000), unseen = torus.points(1501);
  for (int degree = 1; degree <= 3; ++degree) {
    SCOPED_TRACE(degree);
    const auto model = fitted(points, degree, 0.002);
    const double normalError = degree == 1 ? 0.1 : 0.05;
    for (const double offset : {-0.05, -0.02, 0.0, 0.02, 0.05})
      expectNear(*model, shape, unseen, offset, 0.002, normalError);
    // Beyond the reach of the foot points, from the coarse grid.
    for (const double offset : {-0.25, 0.2}) expectNear(*model, shape, unseen, offset, 0.006, 0.35);
    expectNear(*model, shape, unseen, 0.3, 0.02, 0.35);
  }
}

TEST(SlimModel, DistanceAndNormalOfASphereAndABowl) {
  const ExactSphere sphere;
  const auto ball = fitted(sphere.points(30000), 2, 0.0005);
  for (const double offset : {-0.1, -0.03, 0.0, 0.03, 0.1})
    expectNear(
        *ball, [&](const Vec3d& p, Vec3d& n) { return sphere.distance(p, n); }, sphere.points(1201), offset,
        0.0006, 0.02);
  const Bowl bowl;
  const auto model = fitted(bowlPoints(bowl, 60000), 2, 0.001);
  for (const double offset : {-0.04, 0.0, 0.04})
    expectNear(
        *model, [&](const Vec3d& p, Vec3d& n) { return bowlDistance(bowl, p, n); }, bowlPoints(bowl, 3001),
        offset, 0.0015, 0.09);
}

TEST(SlimModel, DistanceAndNormalOfAGlass) {
  Bowl glass;
  glass.height = 1.5;
  const OrientedPoints points = bowlPoints(glass, 3001);
  // Even: as many on the cylinder, inside and outside, as its part of the area.
  const double cylinder = 2 * 2 * std::numbers::pi * 1.5,
               ends = 2 * std::numbers::pi * (0.81 + 1.21) + 2 * std::numbers::pi * std::numbers::pi * 0.1;
  const auto onCylinder = std::count_if(
      points.points.begin(), points.points.end(),
      [](const OrientedPoint& point) { return point.position.y() > 0 && point.position.y() < 1.5F; });
  EXPECT_NEAR(static_cast<double>(onCylinder) / 3001, cylinder / (cylinder + ends), 0.002);
  for (const OrientedPoint& point : points.points) {
    Vec3d normal;
    EXPECT_NEAR(bowlDistance(glass, point.position.cast<double>(), normal), 0, 1e-6);
    EXPECT_GT(normal.dot(point.normal.cast<double>()), 0.999999);
  }
  const auto model = fitted(bowlPoints(glass, 150000), 2, 0.001);
  for (const double offset : {-0.04, 0.0, 0.04})
    expectNear(
        *model, [&](const Vec3d& p, Vec3d& n) { return bowlDistance(glass, p, n); }, points, offset, 0.0015,
        0.09);
}

TEST(SlimModel, InsideAndOutsideAreKnownFarFromTheSurface) {
  const ExactTorus torus;
  const Bowl bowl;
  const auto ring = fitted(torus.points(20000), 2, 0.005), vessel = fitted(bowlPoints(bowl, 40000), 1, 0.004);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-3, 3);
  for (int k = 0; k < 5000; ++k) {
    const Vec3f p(coordinate(random), coordinate(random), coordinate(random));
    Vec3d ignored;
    const double exact = torus.distance(p.cast<double>(), ignored);
    if (std::abs(exact) > 0.01) {
      ASSERT_EQ(ring->nearest(p).distance > 0, exact > 0) << p.transpose();
    }
    const double exactBowl = bowlDistance(bowl, p.cast<double>(), ignored);
    if (std::abs(exactBowl) > 0.01) {
      ASSERT_EQ(vessel->nearest(p).distance > 0, exactBowl > 0) << p.transpose();
    }
    // Outside the grid, too, the distance is good enough to tell near from far.
    ASSERT_NEAR(static_cast<double>(ring->nearest(p).distance), exact, 0.02 + 0.08 * std::abs(exact));
    const float error = ring->coarseError();
    if (std::abs(exact) < 0.5) {
      ASSERT_NEAR(static_cast<double>(ring->coarseDistance(p)), exact, static_cast<double>(error));
    }
  }
}

TEST(SlimModel, GradientAgreesWithDifferences) {
  for (int degree = 1; degree <= 3; ++degree) {
    const auto model = fitted(ExactTorus{}.points(10000), degree, 0.01);
    for (const OrientedPoint& point : ExactTorus{}.points(101).points) {
      const Vec3f p = point.position + 0.01F * point.normal;
      const SlimModel::Value value = model->evaluate(p);
      constexpr float kStep = 2e-3F;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3f step = kStep * Vec3f::Unit(axis);
        const float slope = (model->evaluate(p + step).f - model->evaluate(p - step).f) / (2 * kStep);
        ASSERT_NEAR(value.gradient[axis], slope, 0.01) << "degree " << degree;
      }
    }
  }
}

TEST(SlimModel, EvaluatesWhatItsNodesSay) {
  // Against the definition, node by node.
  const auto model = fitted(ExactTorus{}.points(10000), 3, 0.01);
  for (const OrientedPoint& point : ExactTorus{}.points(101).points) {
    const Vec3d p = point.position.cast<double>();
    double weights = 0, values = 0;
    for (const SlimNode& node : model->nodes()) {
      const Vec3d q = p - node.centre.cast<double>();
      const double t = q.norm() / static_cast<double>(node.radius);
      if (t >= 1) continue;
      const double weight = t < 0.5 ? std::exp(-8 * t * t) : 16 * std::exp(-2.0) * std::pow(1 - t, 4);
      const double u = q.dot(node.tangent.cast<double>()), v = q.dot(node.bitangent().cast<double>()),
                   w = q.dot(node.normal.cast<double>());
      double height = 0;
      int k = 0;
      for (int degree = 0; degree <= 3; ++degree)
        for (int j = 0; j <= degree; ++j, ++k)
          height += static_cast<double>(node.coefficients[static_cast<std::size_t>(k)]) *
                    std::pow(u, degree - j) * std::pow(v, j);
      weights += weight;
      values += weight * (w - height);
    }
    const SlimModel::Value value = model->evaluate(point.position);
    ASSERT_NEAR(static_cast<double>(value.weight), weights, 1e-4);
    ASSERT_NEAR(static_cast<double>(value.f), values / weights, 1e-5);
  }
}

TEST(SlimModel, SearchFindsEveryBallInReach) {
  const auto model = fitted(ExactTorus{}.points(10000), 1, 0.01);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> coordinate(-1.5F, 1.5F);
  for (int k = 0; k < 200; ++k) {
    const Vec3f p(coordinate(random), 0.4F * coordinate(random), coordinate(random));
    std::size_t expected = 0, found = 0;
    for (const SlimNode& node : model->nodes())
      if ((node.centre - p).norm() < 0.3F + node.radius) ++expected;
    model->visitWithin(p, 0.3F, [&](std::uint32_t) { ++found; });
    ASSERT_NEAR(static_cast<double>(found), static_cast<double>(expected), 1.0);
  }
}

}  // namespace slim_model_test
}  // namespace migiwa
