// Walls of triangles against brute force, winding numbers and the shapes that they stand for.
#include "core/walls/mesh_wall.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "core/gamma/baked.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene_file.h"
#include "core/slim/shape_import.h"
#include "core/walls/boundary.h"
#include "core/walls/shapes.h"
#include "tests/support/mesh_shapes.h"

namespace migiwa {
namespace mesh_wall_test {

using testing::ballMesh;
using testing::blockMesh;
using testing::boxMesh;
using testing::sheetMesh;
using testing::together;
using testing::tubeMesh;
using testing::turnedInwards;
using testing::windingNumber;

TriangleWall wallOf(const TriangleMesh& mesh, bool fluidInside, float support = 0) {
  return TriangleWall(std::make_shared<const TriangleTree>(wallFaces(mesh, fluidInside, "test")), fluidInside,
                      support);
}

/// Box, ball or tube, anywhere and any way round in a cube of edge 2; one in three along the axes, with
/// corners at multiples of a quarter, so that faces come to lie on each other.
TriangleMesh randomPart(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::uniform_int_distribution<int> quarters(-4, 2), lengths(1, 4);
  std::uniform_int_distribution<std::uint32_t> rings(6, 11), sides(5, 13);
  const Vec3d middle(unit(random), unit(random), unit(random));
  switch (random() % 5) {
    case 0:
    case 1: {
      const Vec3d low(0.25 * quarters(random), 0.25 * quarters(random), 0.25 * quarters(random));
      return blockMesh(low, low + 0.25 * Vec3d(lengths(random), lengths(random), lengths(random)));
    }
    case 2: {
      const Vec3d a = Vec3d(unit(random), unit(random), unit(random)).normalized(), b = a.unitOrthogonal();
      const double x = 0.3 + 0.2 * unit(random), y = 0.3 + 0.2 * unit(random), z = 0.3 + 0.2 * unit(random);
      return boxMesh(middle, x * a, y * b, z * a.cross(b));
    }
    case 3:
      return ballMesh(middle, 0.4 + 0.2 * unit(random), rings(random));
    default:
      return tubeMesh(middle, Vec3d(unit(random), unit(random), unit(random)), 0.2 + 0.1 * unit(random),
                      sides(random));
  }
}

TriangleMesh randomUnion(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<TriangleMesh> parts;
  const std::size_t count = 1 + random() % 5;
  for (std::size_t k = 0; k < count; ++k) parts.push_back(randomPart(random));
  return together(parts);
}

std::vector<Vec3f> randomPoints(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.6F, 1.6F);
  std::vector<Vec3f> points;
  for (int k = 0; k < count; ++k) points.emplace_back(unit(random), unit(random), unit(random));
  return points;
}

/// What a surface of this many faces, closed or not, encloses by the divergence theorem.
double volumeOf(const std::vector<WallTriangle>& faces) {
  double volume = 0;
  for (const WallTriangle& face : faces)
    volume += face.corners[0].cast<double>().dot(
                  face.corners[1].cast<double>().cross(face.corners[2].cast<double>())) /
              6;
  return volume;
}

TEST(WallFaces, OfRandomUnionsAreWhereTheWindingNumberSaysSo) {
  int wrong = 0, points = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const TriangleMesh mesh = randomUnion(seed);
    const bool inside = seed % 2 == 1;
    const TriangleWall wall = wallOf(mesh, inside);
    for (const Vec3f& p : randomPoints(seed, 60)) {
      const double winding = windingNumber(mesh, p.cast<double>());
      Vec3f normal;
      const float distance = wall.distance(p, normal);
      if (std::abs(distance) < 1e-4F) continue;
      ++points;
      wrong += (winding > 0.5) == ((distance > 0) == inside) ? 0 : 1;
      EXPECT_EQ(winding > 0.5, (distance > 0) == inside)
          << "seed " << seed << " at " << p.transpose() << ": winding " << winding << ", distance "
          << distance;
    }
  }
  EXPECT_GT(points, 11000);
  EXPECT_EQ(wrong, 0);
}

/// The volume within a union, by the parts of a fine grid's cells whose middles are inside.
TEST(WallFaces, OfTwoBoxesEncloseTheirUnion) {
  const TriangleMesh one = blockMesh({0, 0, 0}, {1, 1, 1});
  struct Case {
    Vec3d low, high;
    double volume;
  };
  for (const Case& c : {Case{{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}, 1.875},  // they overlap
                        Case{{1, 0, 0}, {2, 1, 1}, 2},                  // share a face
                        Case{{1, 0.25, 0.25}, {2, 0.75, 0.75}, 1.25},   // a face within a face
                        Case{{0.5, 0, 0}, {1.5, 1, 1}, 1.5},            // four faces in common planes
                        Case{{0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}, 1},   // one within the other
                        Case{{0, 0, 0}, {1, 1, 1}, 1}}) {               // the same twice
    const std::vector<WallTriangle> faces =
        wallFaces(together({one, blockMesh(c.low, c.high)}), false, "test");
    EXPECT_NEAR(volumeOf(faces), c.volume, 1e-6) << c.low.transpose();
  }
  EXPECT_NEAR(
      volumeOf(wallFaces(together({one, turnedInwards(blockMesh({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}))}),
                         false, "test")),
      1 - 1.0 / 64, 1e-6);
}

TEST(TriangleTree, DistancesAreThoseOfAllTriangles) {
  const TriangleMesh mesh =
      together({ballMesh({0.1, 0, 0}, 0.7, 12), tubeMesh({-1, -1, 0}, {1, 1, 0.3}, 0.2, 9)});
  const TriangleTree tree(wallFaces(mesh, false, "test"));
  for (const Vec3f& p : randomPoints(3, 2000)) {
    // By many places on every triangle: never nearer than that, and not much farther.
    float least = std::numeric_limits<float>::infinity();
    for (std::uint32_t k = 0; k < tree.triangles().size(); ++k)
      least = std::min(least, tree.distanceTo(k, p));
    ASSERT_FLOAT_EQ(std::abs(tree.nearest(p).distance), least);
  }
}

TEST(TriangleTree, TheNearestPlaceOfATriangleIsNoFartherThanAnyOther) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int k = 0; k < 300; ++k) {
    const auto point = [&] { return Vec3f(unit(random), unit(random), unit(random)); };
    WallTriangle triangle{{point(), point(), point()}, Vec3f::UnitY()};
    const TriangleTree tree({triangle});
    const Vec3f p = point();
    float least = 10;
    constexpr int kSteps = 60;
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j)
        least =
            std::min(least, (triangle.corners[0] +
                             static_cast<float>(i) / kSteps * (triangle.corners[1] - triangle.corners[0]) +
                             static_cast<float>(j) / kSteps * (triangle.corners[2] - triangle.corners[0]) - p)
                                .norm());
    EXPECT_LE(tree.distanceTo(0, p), least + 1e-5F);
    EXPECT_GE(tree.distanceTo(0, p), least - 0.05F);
  }
}

TEST(TriangleWall, ABoxOfTrianglesIsTheBox) {
  const Vec3d low(-0.4, -0.3, -0.2), high(0.5, 0.6, 0.7);
  const Directions directions = fibonacciDirections(500);
  for (const bool inside : {false, true}) {
    const TriangleWall wall = wallOf(blockMesh(low, high), inside, 0.2F);
    const Box box(low, high, inside ? Box::Fluid::inside : Box::Fluid::outside);
    for (const Vec3f& p : randomPoints(9, 300)) {
      Vec3f one, other;
      const float distance = box.distance(p, other);
      ASSERT_NEAR(wall.distance(p, one), distance, 1e-5);
      if (distance < 1e-3F) continue;
      std::vector<float> hits(directions.size(), 3.0F), expected(directions.size(), 3.0F);
      wall.firstHits(p, directions, hits);
      box.firstHits(p, directions, expected);
      for (std::size_t k = 0; k < hits.size(); ++k) ASSERT_NEAR(hits[k], expected[k], 1e-3) << p.transpose();
    }
  }
}

TEST(TriangleWall, WaysCrossItWhereTheyCrossTheBox) {
  const Vec3d low(-0.4, -0.01, -0.2), high(0.5, 0.01, 0.7);
  const TriangleWall wall = wallOf(blockMesh(low, high), false, 0.2F);
  const Box box(low, high, Box::Fluid::outside);
  const std::vector<Vec3f> from = randomPoints(1, 3000), to = randomPoints(2, 3000);
  int crossed = 0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    Vec3f one, other;
    float entry = 0, expected = 0;
    const bool crosses = box.crosses(from[k], to[k], other, expected);
    if (box.distance(from[k], one) < 0) continue;
    ASSERT_EQ(wall.crosses(from[k], to[k], one, entry), crosses);
    if (!crosses) {
      ASSERT_FALSE(wall.hides(from[k], to[k]));
      continue;
    }
    // Its narrow sides alone hide nothing.
    if (std::abs(other.y()) > 0.5F) {
      ASSERT_TRUE(wall.hides(from[k], to[k]));
    }
    ++crossed;
    ASSERT_NEAR(entry, expected, 1e-5);
    ASSERT_NEAR((one - other).norm(), 0, 1e-5);
  }
  EXPECT_GT(crossed, 100);
}

TEST(TriangleWall, ThicknessIsThatOfItsThinnestPart) {
  const auto thickness = [](const TriangleMesh& mesh) { return wallOf(mesh, false, 0.5F).thickness(); };
  EXPECT_NEAR(thickness(blockMesh({0, 0, 0}, {3, 0.05, 2})), 0.05, 1e-5);
  EXPECT_NEAR(thickness(blockMesh({0, 0, 0}, {3, 0.4, 2})), 0.4, 1e-5);
  EXPECT_TRUE(std::isinf(thickness(blockMesh({0, 0, 0}, {3, 0.6, 2}))));
  EXPECT_TRUE(std::isinf(thickness(ballMesh({0, 0, 0}, 0.5, 12))));
  // A thick block with a thin shelf: each is what it is.
  const TriangleWall wall = wallOf(
      together({blockMesh({0, 0, 0}, {1, 1, 1}), blockMesh({0.9, 0.4, 0}, {3, 0.45, 1})}), false, 0.5F);
  EXPECT_NEAR(wall.thickness(), 0.05, 1e-5);
  EXPECT_TRUE(wall.thinWithin({2, 0.6F, 0.5F}, 0.3F, 0.5F));
  EXPECT_FALSE(wall.thinWithin({0.2F, 1.1F, 0.5F}, 0.3F, 0.5F));
  EXPECT_TRUE(wall.hides({2, 0.6F, 0.5F}, {2, 0.3F, 0.5F}));
  EXPECT_FALSE(wall.hides({0.9F, 1.1F, 0.5F}, {1.1F, 0.9F, 0.5F}));
}

TEST(TriangleWall, ASheetHasFluidOnBothSidesAndEndsAtItsRim) {
  const TriangleWall wall = wallOf(sheetMesh({-0.5, 0, 0.5}, {1, 0, 0}, {0, 0, -1}), false, 0.2F);
  Vec3f normal;
  EXPECT_FLOAT_EQ(wall.distance({0.1F, 0.2F, 0.1F}, normal), 0.2F);
  EXPECT_EQ(normal, Vec3f(0, 1, 0));
  EXPECT_FLOAT_EQ(wall.distance({0.1F, -0.2F, 0.1F}, normal), 0.2F);
  EXPECT_EQ(normal, Vec3f(0, -1, 0));
  // Beyond its rim the rim is what is nearest, and nothing is below.
  EXPECT_FLOAT_EQ(wall.distance({0.8F, -0.4F, 0}, normal), 0.5F);
  EXPECT_NEAR((normal - Vec3f(0.6F, -0.8F, 0)).norm(), 0, 1e-6);
  float entry = 0;
  EXPECT_TRUE(wall.crosses({0.1F, 0.1F, 0.2F}, {0.1F, -0.3F, 0.2F}, normal, entry));
  EXPECT_FLOAT_EQ(entry, 0.25F);
  EXPECT_EQ(normal, Vec3f(0, 1, 0));
  EXPECT_TRUE(wall.crosses({0.1F, -0.1F, 0.2F}, {0.1F, 0.3F, 0.2F}, normal, entry));
  EXPECT_EQ(normal, Vec3f(0, -1, 0));
  EXPECT_FALSE(wall.crosses({0.6F, 0.1F, 0.2F}, {0.6F, -0.3F, 0.2F}, normal, entry));
  EXPECT_EQ(wall.thickness(), 0);
  EXPECT_FALSE(wall.passable(0.2F));
}

/// Squares of a grid of 3^3 cells about the origin, one in three: sheets that meet in all ways, three or four
/// at an edge too, with corners that they share.
TriangleMesh randomSheets(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<TriangleMesh> squares;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 4 * 3 * 3; ++k) {
      if (random() % 3 != 0) continue;
      Vec3d corner(k % 4 - 1.5, k / 4 % 3 - 1.5, k / 12 - 1.5), a = Vec3d::UnitY(), b = Vec3d::UnitZ();
      const auto turned = [axis](const Vec3d& v) {
        return axis == 0 ? v : axis == 1 ? Vec3d(v.z(), v.x(), v.y()) : Vec3d(v.y(), v.z(), v.x());
      };
      if (random() % 2 == 0) std::swap(a, b);
      squares.push_back(sheetMesh(turned(corner), turned(a), turned(b)));
    }
  }
  return together(squares);
}

TEST(TriangleWall, NothingPassesSheetsThatMeetAtEdges) {
  int passes = 0, crossings = 0, walls = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const TriangleMesh mesh = randomSheets(seed);
    TriangleMesh repaired = mesh;
    std::vector<std::string> notes;
    std::vector<WallTriangle> faces;
    try {
      repairMesh(repaired, "test", notes);
      faces = wallFaces(repaired, seed % 2 == 0, "test");
    } catch (const InputError&) {
      continue;  // one-sided
    }
    // Where sheets enclose a cell, it is a solid, and what is in it no wall.
    if (std::any_of(faces.begin(), faces.end(), [](const WallTriangle& face) { return !face.sheet; }))
      continue;
    ++walls;
    const TriangleWall wall(std::make_shared<const TriangleTree>(std::move(faces)), false, 0.2F);
    const std::vector<Vec3f> ends = randomPoints(seed, 2000);
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
      const bool met = testing::meets(mesh, ends[k].cast<double>(), ends[k + 1].cast<double>());
      Vec3f normal;
      float entry = 0;
      ASSERT_EQ(wall.crosses(ends[k], ends[k + 1], normal, entry), met)
          << "seed " << seed << " from " << ends[k].transpose() << " to " << ends[k + 1].transpose();
      ASSERT_EQ(wall.hides(ends[k], ends[k + 1]), met);
      ++(met ? crossings : passes);
    }
  }
  EXPECT_GT(walls, 40);
  EXPECT_GT(passes, 1000);
  EXPECT_GT(crossings, 10000);
}

/// A box with a wall across it, and one that stands on it: where it ends both of its sides are wet, and the
/// box is as solid as without it.
TEST(TriangleWall, AFinOnASolidIsWetOnBothSides) {
  TriangleMesh mesh = blockMesh({0, 0, 0}, {1, 1, 1});
  mesh.vertices.emplace_back(0, 2, 0);
  mesh.vertices.emplace_back(1, 2, 0);
  mesh.triangles.push_back({2, 3, 9});
  mesh.triangles.push_back({2, 9, 8});
  std::vector<std::string> notes;
  ASSERT_FALSE(repairMesh(mesh, "test", notes).closed);
  const TriangleWall wall = wallOf(mesh, false, 0.2F);
  Vec3f normal;
  EXPECT_FLOAT_EQ(wall.distance({0.5F, 0.7F, 0.5F}, normal), -0.3F);
  EXPECT_FLOAT_EQ(wall.distance({0.5F, 1.7F, 0.1F}, normal), 0.1F);
  EXPECT_FLOAT_EQ(wall.distance({0.5F, 1.7F, -0.1F}, normal), 0.1F);
  float entry = 0;
  EXPECT_TRUE(wall.crosses({0.5F, 1.7F, 0.1F}, {0.5F, 1.7F, -0.1F}, normal, entry));
  EXPECT_FALSE(wall.crosses({0.5F, 2.1F, 0.1F}, {0.5F, 2.1F, -0.1F}, normal, entry));
}

TEST(TriangleWall, AWallAcrossABoxPartsItAndHoldsOnBothSides) {
  TriangleMesh mesh = together({blockMesh({0, 0, 0}, {1, 1, 1}), blockMesh({1, 0, 0}, {2, 1, 1})});
  // The square between the two once.
  mesh.triangles.erase(mesh.triangles.begin() + 10, mesh.triangles.begin() + 12);
  std::vector<std::string> notes;
  ASSERT_FALSE(repairMesh(mesh, "test", notes).closed);
  const TriangleWall wall = wallOf(mesh, true, 0.2F);
  Vec3f normal;
  float entry = 0;
  for (const float y : {0.01F, 0.5F, 0.99F}) {
    EXPECT_TRUE(wall.crosses({0.9F, y, 0.5F}, {1.1F, y, 0.5F}, normal, entry));
    EXPECT_TRUE(wall.crosses({1.1F, y, 0.5F}, {0.9F, y, 0.5F}, normal, entry));
    EXPECT_TRUE(wall.crosses({0.1F, y, 0.5F}, {-0.1F, y, 0.5F}, normal, entry));
    EXPECT_TRUE(wall.crosses({1.9F, y, 0.5F}, {2.1F, y, 0.5F}, normal, entry));
  }
}

TEST(TriangleWall, ProjectionEndsAtTheMarginOutsideOfSharpEdgesAndInsideOfCorners) {
  for (const bool inside : {false, true}) {
    const TriangleWall wall = wallOf(randomUnion(15), inside);
    int moved = 0;
    for (const Vec3f& p : randomPoints(4, 2000)) {
      Vec3f q = p, normal;
      const float before = wall.distance(p, normal);
      if (before < -0.02F) continue;
      const bool did = wall.project(q, 0.02F);
      ASSERT_EQ(did, before < 0.02F * (1 - 1e-4F));
      if (did) ++moved;
      if (!inside) {
        ASSERT_GE(wall.distance(q, normal), 0.02F * 0.97F) << p.transpose();
      }
    }
    EXPECT_GT(moved, 10);
  }
}

/// gamma on walls of triangles, by every method that takes any wall, against the same solid as boxes.
TEST(GammaOfMeshes, AtRightAngledEdgesIsWithinAHundredthOfThatOfPlanes) {
  constexpr float kSupport = 0.2F;
  // A room with a step in it: convex and concave edges, and corners of both.
  const std::shared_ptr<const Surface> room = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(2, 2, 2),
                                                                    Box::Fluid::inside),
                                       step = std::make_shared<Box>(Vec3d(-1, -1, -1), Vec3d(1, 1, 1),
                                                                    Box::Fluid::outside);
  const Boundary exact(std::vector{room, step});
  const TriangleMesh mesh = together(
      {blockMesh({1, 0, 0}, {2, 2, 2}), blockMesh({0, 1, 0}, {1, 2, 2}), blockMesh({0, 0, 1}, {1, 1, 2})});
  const Boundary meshed(std::vector<std::shared_ptr<const Surface>>{
      std::make_shared<TriangleWall>(wallOf(mesh, true, kSupport))});
  const auto names = gammaMethodNames();
  const auto make = [&](const Boundary& boundary, std::string_view name, int directions) {
    const auto index = static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
    ThreadPool pool(2);
    return makeGammaMethod(index, {boundary, KernelType::poly6, kSupport, directions, 100000, {}, &pool})
        .method;
  };
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 2), near(-0.2F, 0.2F);
  std::vector<Float4> points;
  while (points.size() < 1500) {
    Vec3f p(unit(random), unit(random), unit(random));
    const int axis = static_cast<int>(random() % 3), other = (axis + 1) % 3;
    p[axis] = 1 + near(random), p[other] = 1 + near(random);
    if (exact.distance(p) > 0.05F) points.emplace_back(p);
  }
  std::vector<GammaSample> expected(points.size()), found(points.size());
  make(exact, "directions", 16384)->evaluate(points, expected);
  for (const char* name : {"auto", "baked", "directions"}) {
    make(meshed, name, 1024)->evaluate(points, found);
    float worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      worst = std::max(worst, std::abs(found[i].gamma - expected[i].gamma));
    EXPECT_LT(worst, 0.01F) << name;
  }
}

/// What is kept on disk about walls goes by their description: two clouds must not pass for each other.
TEST(MeshSurface, OfPointsIsToldByWhatIsInItsFile) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "clouds";
  std::filesystem::create_directories(folder);
  std::vector<std::string> descriptions;
  for (const double radius : {0.3, 0.25}) {
    const Directions directions = fibonacciDirections(400);
    std::ofstream file(folder / "cloud.xyz");
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Vec3d n(directions.x[k], directions.y[k], directions.z[k]);
      file << radius * n.x() << ' ' << radius * n.y() << ' ' << radius * n.z() << ' ' << n.x() << ' ' << n.y()
           << ' ' << n.z() << '\n';
    }
    file.close();
    const Scene scene = parseScene(
        R"({ "format": 1, "boundary": { "surfaces": [
           { "shape": "mesh", "file": "cloud.xyz", "fluid": "inside" } ] } })",
        folder / "scene.json");
    const Boundary walls(wallsFor(scene.surfaces, 0.1F));
    EXPECT_NEAR(walls.distance(Vec3f::Zero()), radius, 0.01);
    ASSERT_TRUE(scene.surfaces.front()->fitError());
    EXPECT_LT(*scene.surfaces.front()->fitError(), 0.01);
    descriptions.push_back(describeWalls(walls));
  }
  EXPECT_NE(descriptions[0], descriptions[1]);
  std::filesystem::remove_all(folder);
}

TEST(BoxOf, SeesABoxHoweverItIsTurnedAndNothingElse) {
  const Rotation turn{{1, 2, -0.5}, 37};
  const Eigen::Matrix3d axes = turn.matrix();
  const TriangleMesh box = boxMesh({0.3, -0.2, 0.7}, 0.5 * axes.col(0), 0.7 * axes.col(1), 0.9 * axes.col(2));
  for (const bool inside : {false, true}) {
    const std::optional<BoxGeometry> found = boxOf(wallFaces(box, inside, "test"));
    ASSERT_TRUE(found);
    const Vec3d half = found->halfExtents;
    EXPECT_NEAR(half.prod() * 8, 0.5 * 0.7 * 0.9, 1e-6);
    EXPECT_NEAR((found->center - Vec3d(0.3, -0.2, 0.7) - 0.5 * axes * Vec3d(0.5, 0.7, 0.9)).norm(), 0, 1e-6);
    EXPECT_NEAR((found->axes.transpose() * found->axes - Eigen::Matrix3d::Identity()).norm(), 0, 1e-6);
  }
  EXPECT_FALSE(boxOf(wallFaces(boxMesh({0, 0, 0}, {1, 0, 0}, {0.1, 1, 0}, {0, 0, 1}), false, "test")));
  EXPECT_FALSE(boxOf(wallFaces(ballMesh({0, 0, 0}, 1, 2), false, "test")));
  // What lies within a box adds nothing to it.
  EXPECT_TRUE(boxOf(wallFaces(
      together({blockMesh({0, 0, 0}, {1, 1, 1}), blockMesh({0, 0, 0}, {0.5, 1, 0.5})}), false, "test")));
}

}  // namespace mesh_wall_test
}  // namespace migiwa
