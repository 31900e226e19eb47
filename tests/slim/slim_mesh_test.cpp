// Meshes of SLIM surfaces against the closed forms of what the surfaces were fitted to.
#include <map>

#include <gtest/gtest.h>

#include "core/slim/fit.h"
#include "core/slim/mesh.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa {
namespace slim_mesh_test {

using testing::ExactSphere;
using testing::ExactTorus;

constexpr double kPi = std::numbers::pi;

std::unique_ptr<SlimModel> fitted(const OrientedPoints& points, int degree, double tolerance) {
  ThreadPool pool(2);
  SlimFitOptions options;
  options.degree = degree;
  options.tolerance = tolerance;
  return std::make_unique<SlimModel>(fitSlim(points, options, pool), degree, points.closed, pool);
}

SlimMesh meshOf(const SlimModel& model, double mostTriangles = kMostSlimTriangles, int threads = 2) {
  ThreadPool pool(threads);
  return extractSlimMesh(model, pool, mostTriangles);
}

struct Figures {
  double area = 0, volume = 0;  ///< (m^2, m^3), the latter by the divergence theorem
  long euler = 0;               ///< vertices - edges + triangles: 2 for a sphere, 0 for a torus
  long openEdges = 0;           ///< without a triangle on the other side that runs the other way
  long crowdedEdges = 0;        ///< with more than one triangle on a side
};

Figures figuresOf(const SlimMesh& mesh) {
  Figures figures;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& corners : mesh.surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++sides[{corners[k], corners[(k + 1) % 3]}];
    const Vec3d a = mesh.surface.vertices[corners[0]].cast<double>(),
                b = mesh.surface.vertices[corners[1]].cast<double>(),
                c = mesh.surface.vertices[corners[2]].cast<double>();
    figures.area += 0.5 * (b - a).cross(c - a).norm();
    figures.volume += a.dot(b.cross(c)) / 6;
  }
  for (const auto& [side, count] : sides) {
    figures.crowdedEdges += count > 1 ? 1 : 0;
    figures.openEdges += sides.contains({side.second, side.first}) ? 0 : 1;
  }
  figures.euler = static_cast<long>(mesh.surface.vertices.size()) -
                  (static_cast<long>(sides.size()) + figures.openEdges) / 2 +
                  static_cast<long>(mesh.surface.triangles.size());
  return figures;
}

/// Largest distance (m) of a vertex to `shape`, and the largest angle (rad) of its normal to the shape's.
template <class Shape>
std::pair<double, double> errorsOf(const SlimMesh& mesh, const Shape& shape) {
  double distance = 0, angle = 0;
  for (std::size_t k = 0; k < mesh.surface.vertices.size(); ++k) {
    Vec3d normal;
    distance = std::max(distance, std::abs(shape(mesh.surface.vertices[k].cast<double>(), normal)));
    angle = std::max(angle, std::acos(std::min(1.0, normal.dot(mesh.normals[k].cast<double>()))));
  }
  return {distance, angle};
}

TEST(SlimMesh, SphereIsClosedAndHasItsAreaAndVolume) {
  const ExactSphere sphere;
  for (int degree = 1; degree <= 3; ++degree) {
    SCOPED_TRACE(degree);
    constexpr double kTolerance = 0.0005;
    const SlimMesh mesh = meshOf(*fitted(sphere.points(30000), degree, kTolerance), 40000);
    const Figures figures = figuresOf(mesh);
    EXPECT_EQ(figures.openEdges, 0);
    EXPECT_EQ(figures.crowdedEdges, 0);
    EXPECT_EQ(figures.euler, 2);
    EXPECT_NEAR(figures.volume, 4 * kPi / 3, 0.001 * 4 * kPi / 3);
    EXPECT_NEAR(figures.area, 4 * kPi, 0.001 * 4 * kPi);
    const auto [distance, angle] =
        errorsOf(mesh, [&](const Vec3d& p, Vec3d& normal) { return sphere.distance(p, normal); });
    // The fit keeps its tolerance at its own points; between them a little is added.
    EXPECT_LT(distance, 1.5 * kTolerance);
    EXPECT_LT(angle, degree == 1 ? 0.06 : 0.02);
  }
}

TEST(SlimMesh, TorusAndBowlAreClosedToo) {
  const ExactTorus torus;
  const SlimMesh ring = meshOf(*fitted(torus.points(30000), 2, 0.001), 40000);
  const Figures figures = figuresOf(ring);
  EXPECT_EQ(figures.openEdges, 0);
  EXPECT_EQ(figures.crowdedEdges, 0);
  EXPECT_EQ(figures.euler, 0) << "one hole";
  EXPECT_NEAR(figures.volume, 2 * kPi * kPi * 0.16, 0.002 * 2 * kPi * kPi * 0.16);
  EXPECT_NEAR(figures.area, 4 * kPi * kPi * 0.4, 0.002 * 4 * kPi * kPi * 0.4);
  const auto [distance, angle] =
      errorsOf(ring, [&](const Vec3d& p, Vec3d& normal) { return torus.distance(p, normal); });
  EXPECT_LT(distance, 0.0015);
  EXPECT_LT(angle, 0.05);

  // A thin wall: two half spheres, and half a torus for a rim.
  Bowl bowl;
  bowl.center = Vec3d::Zero();
  bowl.radius = 1.3;
  bowl.thickness = 0.1;
  const SlimMesh vessel = meshOf(*fitted(bowlPoints(bowl, 60000), 2, 0.002));
  const Figures wall = figuresOf(vessel);
  EXPECT_EQ(wall.openEdges, 0);
  EXPECT_EQ(wall.crowdedEdges, 0);
  EXPECT_EQ(wall.euler, 2);
  const double half = 0.5 * bowl.thickness, inner = bowl.radius - half, outer = bowl.radius + half;
  const double volume = 2 * kPi / 3 * (std::pow(outer, 3) - std::pow(inner, 3)) +
                        kPi * half * half / 2 * 2 * kPi * bowl.radius;  // Pappus
  EXPECT_NEAR(wall.volume, volume, 0.005 * volume);
}

TEST(SlimMesh, FlatTrianglesMissLessTheMoreThereAre) {
  // Chords of a sphere: what they cut off falls with the square of the cell, as the triangles' inverse.
  const auto model = fitted(ExactSphere{}.points(30000), 3, 0.0001);
  const auto missing = [&](double triangles) {
    return 4 * kPi / 3 - figuresOf(meshOf(*model, triangles)).volume;
  };
  const double few = missing(8000), many = missing(32000);
  EXPECT_GT(few, 0);
  EXPECT_NEAR(few / many, 4, 0.8);
}

TEST(SlimMesh, KeepsToItsBudget) {
  const auto model = fitted(ExactTorus{}.points(30000), 1, 0.002);
  for (const double most : {20000.0, 60000.0}) {
    const auto count = static_cast<double>(meshOf(*model, most).surface.triangles.size());
    EXPECT_LT(count, 1.1 * most);
    EXPECT_GT(count, 0.7 * most) << "fine nodes use all of it";
  }
}

TEST(SlimMesh, IsTheSameForAnyNumberOfThreads) {
  const auto model = fitted(ExactTorus{}.points(20000), 2, 0.002);
  const SlimMesh one = meshOf(*model, 20000, 1), three = meshOf(*model, 20000, 3);
  EXPECT_EQ(one.surface.vertices, three.surface.vertices);
  EXPECT_EQ(one.surface.triangles, three.surface.triangles);
  EXPECT_EQ(one.normals, three.normals);
}

TEST(SlimMesh, OpenSurfaceEndsAtItsRim) {
  OrientedPoints half;
  for (const OrientedPoint& point : ExactSphere{}.points(40000).points)
    if (point.position.y() > 0) half.points.push_back(point);
  half.closed = false;
  const auto model = fitted(half, 2, 0.0005);
  const SlimMesh mesh = meshOf(*model, 40000);
  const Figures figures = figuresOf(mesh);
  EXPECT_GT(figures.openEdges, 0);
  EXPECT_EQ(figures.crowdedEdges, 0);
  // All that the points cover, and beyond them no more than a ball's core.
  const float reach = kSlimCore * model->largestRadius();
  EXPECT_GT(figures.area, 0.99 * 2 * kPi);
  EXPECT_LT(figures.area, 2 * kPi * (1 + static_cast<double>(reach)));
  for (const Vec3f& vertex : mesh.surface.vertices) {
    ASSERT_GT(vertex.y(), -reach);
    ASSERT_NEAR(static_cast<double>(vertex.norm()), 1, 0.01);
  }
}

}  // namespace slim_mesh_test
}  // namespace migiwa
