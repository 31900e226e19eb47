// Hierarchies of balls: whatever tolerance cuts one, the cut covers every point, keeps the tolerance, and
// takes about as many balls as a fit of its own.
#include <gtest/gtest.h>

#include "core/slim/fit.h"
#include "core/slim/model.h"
#include "core/slim/points.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace slim_hierarchy_test {

struct Shape {
  const char* name;
  OrientedPoints points;
};

std::vector<Shape> shapes() {
  return {{"sphere", testing::ExactSphere{}.points(20000)},
          {"torus", testing::ExactTorus{}.points(20000)},
          {"bowl", bowlPoints({Vec3d::Zero(), 1, 0.3}, 40000)}};
}

std::vector<SlimNode> fitted(const OrientedPoints& points, int degree, double tolerance) {
  ThreadPool pool(2);
  SlimFitOptions options;
  options.degree = degree;
  options.tolerance = tolerance;
  return fitSlim(points, options, pool);
}

TEST(SlimHierarchy, EveryCutCoversThePointsAndKeepsItsTolerance) {
  ThreadPool pool(2);
  for (const Shape& shape : shapes()) {
    for (int degree = 1; degree <= 3; ++degree) {
      SCOPED_TRACE(std::string(shape.name) + ", degree " + std::to_string(degree));
      const std::vector<SlimNode> nodes = fitted(shape.points, degree, 0.004);
      const SlimHierarchy hierarchy = mergeSlim(shape.points, nodes, degree, pool);
      std::size_t last = nodes.size() + 1;
      // Beyond, balls are as wide as the bowl's wall is thick, and do not merge.
      for (const double tolerance : {0.004, 0.007, 0.013}) {
        const std::vector<SlimNode> cut = cutSlim(nodes, hierarchy, tolerance);
        EXPECT_LE(cut.size(), last);
        last = cut.size();
        for (const SlimNode& node : cut) ASSERT_LE(node.error, tolerance);
        const SlimModel model(cut, degree, true, pool);
        for (const OrientedPoint& point : shape.points.points) {
          const SlimModel::Value value = model.evaluate(point.position);
          ASSERT_GE(value.weight, 0.088F) << "the weight at the rim of a core";
          // A polynomial is held to its points up to 0.7 radii, and speaks, weakly, up to one.
          ASSERT_LT(std::abs(value.f), 2 * tolerance);
        }
        const std::size_t direct = fitted(shape.points, degree, tolerance).size();
        EXPECT_LT(static_cast<double>(cut.size()), 1.25 * static_cast<double>(direct)) << tolerance;
      }
    }
  }
}

TEST(SlimHierarchy, CutsToANumberOfNodes) {
  ThreadPool pool(2);
  const OrientedPoints points = testing::ExactTorus{}.points(20000);
  const std::vector<SlimNode> nodes = fitted(points, 2, 0.001);
  const SlimHierarchy hierarchy = mergeSlim(points, nodes, 2, pool);
  const std::size_t roots = nodes.size() - hierarchy.merged.size();
  EXPECT_EQ(cutSlim(nodes, hierarchy, toleranceFor(nodes, hierarchy, 1)).size(), roots);
  for (std::size_t wanted = roots + 10; wanted < nodes.size(); wanted += wanted / 2) {
    const std::size_t found = cutSlim(nodes, hierarchy, toleranceFor(nodes, hierarchy, wanted)).size();
    EXPECT_LE(found, wanted);
    EXPECT_GE(found, wanted - 2) << "only balls of exactly the same error go together";
  }
  EXPECT_EQ(toleranceFor(nodes, hierarchy, nodes.size()), 0);
}

TEST(SlimHierarchy, IsATree) {
  ThreadPool pool(1);
  const OrientedPoints points = testing::ExactSphere{}.points(5000);
  const std::vector<SlimNode> nodes = fitted(points, 1, 0.01);
  const SlimHierarchy hierarchy = mergeSlim(points, nodes, 1, pool);
  std::vector<int> parents(nodes.size() + hierarchy.merged.size(), 0);
  ASSERT_EQ(hierarchy.children.size(), hierarchy.merged.size());
  for (std::size_t k = 0; k < hierarchy.merged.size(); ++k) {
    for (const std::uint32_t child : hierarchy.children[k]) {
      ASSERT_LT(child, nodes.size() + k);
      EXPECT_EQ(++parents[child], 1);
    }
  }
}

TEST(SlimHierarchy, IsTheSameForAnyNumberOfThreads) {
  const OrientedPoints points = testing::ExactTorus{}.points(5000);
  const std::vector<SlimNode> nodes = fitted(points, 2, 0.005);
  ThreadPool one(1), four(4);
  const SlimHierarchy a = mergeSlim(points, nodes, 2, one), b = mergeSlim(points, nodes, 2, four);
  EXPECT_EQ(a.children, b.children);
  ASSERT_EQ(a.merged.size(), b.merged.size());
  for (std::size_t k = 0; k < a.merged.size(); ++k) {
    ASSERT_EQ(a.merged[k].centre, b.merged[k].centre);
    ASSERT_EQ(a.merged[k].radius, b.merged[k].radius);
    ASSERT_EQ(a.merged[k].coefficients, b.merged[k].coefficients);
  }
}

TEST(SlimHierarchy, SaysWhatAFileDoesNotHold) {
  ThreadPool pool(1);
  const OrientedPoints points = testing::ExactSphere{}.points(5000);
  SlimData data;
  data.degree = 1;
  data.nodes = fitted(points, 1, 0.01);
  data.hierarchy = mergeSlim(points, data.nodes, 1, pool);
  SlimData coarse = data, fine = data, many = data, few = data, fewest = data, old = data;
  EXPECT_EQ(cutTo(coarse, 0.04, 0), "");
  EXPECT_LT(coarse.nodes.size(), data.nodes.size() / 2);
  EXPECT_NE(cutTo(fine, 1e-4, 0).find("nodes err by more than the tolerance of 0.0001 m"), std::string::npos);
  EXPECT_EQ(fine.nodes.size(), data.nodes.size());
  EXPECT_NE(cutTo(many, 0, 100000).find("fewer than the 100000 asked for"), std::string::npos);
  EXPECT_EQ(cutTo(few, 0, 60), "");
  EXPECT_LE(few.nodes.size(), 60U);
  EXPECT_NE(cutTo(fewest, 0, 1).find("no fewer than"), std::string::npos);
  old.hierarchy = {};
  EXPECT_NE(cutTo(old, 0.04, 0).find("it holds no coarser levels"), std::string::npos);
}

TEST(EnclosingBall, IsHardlyLargerThanTheSmallest) {
  RandomSequence random(7);
  for (int round = 0; round < 50; ++round) {
    // Points in a ball, a few of them on its rim all around: that ball is the smallest.
    const Vec3f centre(3, -2, 1);
    Extremes odd, even;
    std::vector<Vec3f> points;
    for (int k = 0; k < 200; ++k) {
      Vec3f p;
      do {
        p = {static_cast<float>(2 * random.unit() - 1), static_cast<float>(2 * random.unit() - 1),
             static_cast<float>(2 * random.unit() - 1)};
      } while (p.norm() > 1);
      if (k < 40) p.normalize();
      points.push_back(centre + p);
      (k % 2 == 0 ? even : odd).include(points.back());
    }
    odd.include(even);
    float radius = 0;
    for (const Vec3f& p : points) radius = std::max(radius, (p - odd.centre()).norm());
    EXPECT_LT(radius, 1.1F);
  }
}

}  // namespace slim_hierarchy_test
}  // namespace migiwa
