// Estimated normals against the exact ones of shapes, thin walls included, and errors where it cannot be
// known.
#include <functional>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/slim/fit.h"
#include "core/slim/points.h"
#include "core/slim/shape_import.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace normal_estimation_test {

using Shape = std::function<double(const Vec3d&, Vec3d&)>;

struct Errors {
  std::size_t turned = 0;       ///< normals that face the wrong way
  double largest = 0, rms = 0;  ///< angle to the exact normal or its opposite (rad)
};

/// Forgets the normals, estimates them, and compares them with the exact ones.
Errors errorsOf(OrientedPoints points, const Shape& shape) {
  for (OrientedPoint& point : points.points) point.normal.setZero();
  estimateNormals(points.points, "x.ply");
  Errors errors;
  for (const OrientedPoint& point : points.points) {
    Vec3d exact;
    shape(point.position.cast<double>(), exact);
    const double cosine = point.normal.cast<double>().dot(exact);
    if (cosine < 0) ++errors.turned;
    const double angle = std::acos(std::min(1.0, std::abs(cosine)));
    errors.largest = std::max(errors.largest, angle);
    errors.rms += angle * angle / static_cast<double>(points.points.size());
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

TEST(NormalEstimation, OfASphereATorusAndABowl) {
  const testing::ExactSphere sphere;
  const testing::ExactTorus torus;
  const Bowl bowl{Vec3d::Zero(), 1.3, 0.2};  // the one of scenes/bowl.json
  const std::vector<std::pair<OrientedPoints, Shape>> shapes{
      {sphere.points(5000), [&](const Vec3d& p, Vec3d& n) { return sphere.distance(p, n); }},
      {torus.points(8000), [&](const Vec3d& p, Vec3d& n) { return torus.distance(p, n); }},
      {bowlPoints(bowl, 20000), [&](const Vec3d& p, Vec3d& n) { return bowlDistance(bowl, p, n); }}};
  for (const auto& [points, shape] : shapes) {
    const Errors errors = errorsOf(points, shape);
    std::printf("%zu points: largest angle %.3f, rms %.4f rad\n", points.points.size(), errors.largest,
                errors.rms);
    EXPECT_EQ(errors.turned, 0U);
    EXPECT_LT(errors.largest, 0.25);
    EXPECT_LT(errors.rms, 0.05);
  }
}

TEST(NormalEstimation, OfPointsThatAreUnevenAndNoisy) {
  const testing::ExactTorus torus;
  RandomSequence random(11);
  OrientedPoints points = torus.points(20000);
  // More than half of them gone on one side, and noise of a fifth of their distance.
  std::erase_if(points.points,
                [&](const OrientedPoint& p) { return p.position.x() > 0 && random.unit() < 0.6; });
  for (OrientedPoint& point : points.points)
    point.position += 0.006F * static_cast<float>(2 * random.unit() - 1) * point.normal;
  const Errors errors = errorsOf(points, [&](const Vec3d& p, Vec3d& n) { return torus.distance(p, n); });
  EXPECT_EQ(errors.turned, 0U);
  EXPECT_LT(errors.rms, 0.2);
}

TEST(NormalEstimation, TheWallOfAHollowFacesTheHollow) {
  const testing::ExactSphere outer{2}, inner{1};
  OrientedPoints points = outer.points(8000);
  for (OrientedPoint point : inner.points(3000).points) {
    point.normal = -point.normal;
    points.points.push_back(point);
  }
  const Errors errors = errorsOf(points, [](const Vec3d& p, Vec3d& n) {
    n = p.normalized() * (p.norm() > 1.5 ? 1 : -1);
    return 0.0;
  });
  EXPECT_EQ(errors.turned, 0U);
}

TEST(NormalEstimation, DoesNotDependOnTheOrderOfEqualRuns) {
  OrientedPoints a = testing::ExactTorus{}.points(3000), b = a;
  estimateNormals(a.points, "x.ply");
  estimateNormals(b.points, "x.ply");
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    EXPECT_EQ(a.points[k].position, b.points[k].position);
    EXPECT_EQ(a.points[k].normal, b.points[k].normal);
  }
}

std::string faultOf(std::vector<OrientedPoint> points) {
  try {
    estimateNormals(points, "x.ply");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(NormalEstimation, SaysWhereItCannotBeKnown) {
  std::vector<OrientedPoint> sheet;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      sheet.push_back(
          {{0.1F * static_cast<float>(i), 0.03F * static_cast<float>(i % 3), 0.1F * static_cast<float>(j)},
           Vec3f::Zero()});
  EXPECT_NE(faultOf(sheet).find("x.ply: expected points with normals, or points all over"),
            std::string::npos);
  EXPECT_NE(faultOf(sheet).find("they do not cover a closed surface"), std::string::npos);
  // A wall thinner than its points are apart.
  EXPECT_NE(faultOf(bowlPoints({Vec3d::Zero(), 1.3, 0.02}, 4000).points).find("cannot be told apart"),
            std::string::npos);
  // Dust.
  RandomSequence random(3);
  std::vector<OrientedPoint> dust(2000);
  for (OrientedPoint& point : dust)
    for (int axis = 0; axis < 3; ++axis) point.position[axis] = static_cast<float>(random.unit());
  EXPECT_NE(faultOf(dust).find("cannot be told apart"), std::string::npos);
}

TEST(NormalEstimation, TurnsGivenNormalsOnlyWhereTheyDisagree) {
  OrientedPoints points = testing::ExactTorus{}.points(5000);
  EXPECT_EQ(orientNormals(points.points), 0U);
  std::size_t wrong = 0;
  for (OrientedPoint& point : points.points) {
    if (point.position.x() < 0.3F) continue;
    point.normal = -point.normal;
    ++wrong;
  }
  EXPECT_EQ(orientNormals(points.points), wrong);
  const testing::ExactTorus torus;
  for (const OrientedPoint& point : points.points) {
    Vec3d exact;
    torus.distance(point.position.cast<double>(), exact);
    ASSERT_GT(point.normal.cast<double>().dot(exact), 0.99);
  }
}

}  // namespace normal_estimation_test
}  // namespace migiwa
