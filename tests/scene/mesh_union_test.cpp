// Unions of boxes, balls and tubes at random as fluid: which cells are filled, against the winding number by
// the solid angle of every triangle (Van Oosterom and Strackee 1983, The solid angle of a plane triangle),
// and the volume against that of the half-spaces the parts are made of.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/scene/sources.h"
#include "core/slim/shape_import.h"
#include "tests/support/mesh_shapes.h"

namespace migiwa::testing {
namespace mesh_union_test {

constexpr double kSpacing = 1.0 / 32;

/// The half-spaces behind the faces of a convex mesh.
struct Convex {
  std::vector<std::pair<Vec3d, double>> faces;

  explicit Convex(const TriangleMesh& mesh) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3d p = mesh.vertices[a].cast<double>();
      const Vec3d normal =
          (mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p).normalized();
      faces.emplace_back(normal, normal.dot(p));
    }
  }
  bool contains(const Vec3d& p) const {
    return std::all_of(faces.begin(), faces.end(),
                       [&](const auto& face) { return face.first.dot(p) <= face.second; });
  }
};

void append(TriangleMesh& mesh, const TriangleMesh& part, bool turned = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const auto& [a, b, c] : part.triangles)
    mesh.triangles.push_back(turned ? std::array{a + first, c + first, b + first}
                                    : std::array{a + first, b + first, c + first});
}

/// Rings of points about the y axis from above to below; a ring of no radius is a tip.
TriangleMesh turned(const std::vector<std::array<double, 2>>& profile, std::uint32_t sectors) {
  TriangleMesh mesh;
  std::vector<std::vector<std::uint32_t>> rings;
  for (const auto& [radius, y] : profile) {
    std::vector<std::uint32_t> ring;
    for (std::uint32_t k = 0; k < (radius > 0 ? sectors : 1); ++k) {
      const double angle = 2 * std::numbers::pi * k / sectors;
      ring.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.emplace_back(Vec3d(radius * std::cos(angle), y, radius * std::sin(angle)).cast<float>());
    }
    rings.push_back(std::move(ring));
  }
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
    for (std::size_t k = 0; k < sectors; ++k) {
      const auto &above = rings[r], &below = rings[r + 1];
      const std::uint32_t a = above[k % above.size()], b = above[(k + 1) % sectors % above.size()],
                          c = below[(k + 1) % sectors % below.size()], d = below[k % below.size()];
      if (a != b) mesh.triangles.push_back({a, b, c});
      if (c != d) mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

TriangleMesh ball(double radius) {
  std::vector<std::array<double, 2>> profile{{0, radius}};
  for (int ring = 1; ring < 7; ++ring)
    profile.push_back(
        {radius * std::sin(std::numbers::pi * ring / 7), radius * std::cos(std::numbers::pi * ring / 7)});
  profile.push_back({0, -radius});
  return turned(profile, 11);
}

TriangleMesh rod(double radius, double length) {
  return turned({{0, length / 2}, {radius, length / 2}, {radius, -length / 2}, {0, -length / 2}}, 12);
}

/// A pipe, open at both ends.
TriangleMesh pipe(double radius, double within, double length) {
  const double half = length / 2;
  return turned({{within, half}, {radius, half}, {radius, -half}, {within, -half}, {within, half}}, 12);
}

struct Union {
  TriangleMesh mesh;
  std::vector<Convex> solids, holes;  ///< holes[k] is what is missing of solids[k]
  Bounds bounds;
  bool aligned = false;

  bool contains(const Vec3d& p) const {
    for (std::size_t k = 0; k < solids.size(); ++k)
      if (solids[k].contains(p) && (holes[k].faces.empty() || !holes[k].contains(p))) return true;
    return false;
  }
};

/// On the lattice, half of which lies on centres of cells; or upright anywhere; or anywhere and turned.
Union randomUnion(std::uint64_t seed) {
  RandomSequence random(seed);
  Union result;
  const std::uint64_t manner = random.below(3);
  const bool aligned = result.aligned = manner == 0;
  const auto parts = 2 + random.below(4);
  for (std::uint64_t k = 0; k < parts; ++k) {
    const auto snapped = [&](double value) {
      return aligned ? std::round(2 * value / kSpacing) * kSpacing / 2 : value;
    };
    const auto between = [&](double low, double high) { return snapped(low + (high - low) * random.unit()); };
    TriangleMesh part, hole;
    const std::uint64_t kind = random.below(4);
    if (kind == 0) {
      const Vec3d size(between(0.3, 0.7), between(0.3, 0.7), between(0.3, 0.7));
      part = boxMesh(-0.5 * size, {size.x(), 0, 0}, {0, size.y(), 0}, {0, 0, size.z()});
    } else if (kind == 1) {
      part = ball(between(0.2, 0.4));
    } else {
      const double radius = between(0.2, 0.35), length = between(0.4, 0.8);
      part = rod(radius, length);
      if (kind == 3) {
        hole = rod(0.6 * radius, length);
        part = pipe(radius, 0.6 * radius, length);
      }
    }
    const Vec3d axis = Vec3d(random.unit(), random.unit(), random.unit() + 0.1).normalized();
    const Transform place{.scale = 1,
                          .rotate = {.axis = axis, .degrees = manner < 2 ? 0 : 180 * random.unit()},
                          .translate = {between(-0.3, 0.3), between(-0.3, 0.3), between(-0.3, 0.3)}};
    for (TriangleMesh* mesh : {&part, &hole})
      for (Vec3f& vertex : mesh->vertices) vertex = place.point(vertex);
    append(result.mesh, part);
    if (kind == 3) {
      // The outside of a pipe is that of the faces that do not look at its axis.
      TriangleMesh outside = part;
      std::erase_if(outside.triangles, [&](const auto& t) {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return v < 12 || v >= 36; });
      });
      result.solids.emplace_back(outside);
    } else {
      result.solids.emplace_back(part);
    }
    result.holes.emplace_back(hole);
  }
  result.bounds = result.mesh.bounds();
  return result;
}

TEST(MeshUnion, CellsAreFilledWhereTheWindingNumberSays) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Union shape = randomUnion(seed);
    std::vector<std::string> notes;
    ASSERT_TRUE(repairMesh(shape.mesh, "union", notes).closed);
    std::vector<Vec3d> centers;
    fillMesh(shape.mesh, kSpacing, centers);
    ASSERT_LE(static_cast<double>(centers.size()), MeshSource(shape.mesh).count(kSpacing));

    const Eigen::Array3d cells = (shape.bounds.size() / kSpacing).array().round();
    Vec3d first = shape.bounds.center() - 0.5 * kSpacing * (cells - 1).matrix();
    first -= kSpacing * movedBy(centers[0], first, kSpacing);
    std::set<std::array<long, 3>> filled;
    for (const Vec3d& p : centers) {
      const Vec3d cell = (p - first) / kSpacing;
      filled.insert({std::lround(cell.x()), std::lround(cell.y()), std::lround(cell.z())});
    }
    ASSERT_EQ(filled.size(), centers.size()) << "a cell is filled twice";
    RandomSequence random(seed + 1000);
    for (int k = 0; k < 150; ++k) {
      std::array<long, 3> cell{};
      for (int axis = 0; axis < 3; ++axis)
        cell[static_cast<std::size_t>(axis)] =
            static_cast<long>(random.below(static_cast<std::uint64_t>(cells[axis])));
      // Faces may lie on the centres: next to one, as the filling decides it, it has to be right.
      const Vec3d center = first + kSpacing * Vec3d(double(cell[0]) + 1.2345e-7, double(cell[1]) + 3.1416e-7,
                                                    double(cell[2]) + 2.7183e-7);
      ASSERT_EQ(filled.contains(cell), std::lround(windingNumber(shape.mesh, center)) >= 1)
          << cell[0] << ' ' << cell[1] << ' ' << cell[2];
    }

    // The volume, by the first points of Roberts' R3 sequence in the bounds.
    constexpr int kPoints = 40000;
    int within = 0;
    Vec3d u = Vec3d::Constant(0.5);
    for (int k = 0; k < kPoints; ++k) {
      u += Vec3d(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
      u = u.unaryExpr([](double x) { return x - std::floor(x); });
      if (shape.contains(shape.bounds.min + u.cwiseProduct(shape.bounds.size()))) ++within;
    }
    const double volume = shape.bounds.size().prod() * within / kPoints;
    // Where all faces lie on boundaries and middles of cells, no lattice as coarse as that comes near enough.
    const double spacing = shape.aligned ? 0.27 * kSpacing : kSpacing;
    if (shape.aligned) {
      centers.clear();
      fillMesh(shape.mesh, spacing, centers);
    }
    EXPECT_NEAR(static_cast<double>(centers.size()) * std::pow(spacing, 3), volume, 0.02 * volume);
  }
}

TEST(MeshUnion, AHollowStaysEmptyAndAPartWithinAPartDoesNot) {
  TriangleMesh hollow = ball(0.5), solid = hollow;
  append(hollow, ball(0.3), true);
  append(solid, ball(0.3));
  std::vector<Vec3d> whole, within, both, less;
  fillMesh(ball(0.5), kSpacing, whole);
  fillMesh(ball(0.3), kSpacing, within);
  fillMesh(solid, kSpacing, both);
  fillMesh(hollow, kSpacing, less);
  EXPECT_EQ(both.size(), whole.size());
  EXPECT_NEAR(static_cast<double>(less.size()), static_cast<double>(whole.size() - within.size()),
              0.02 * static_cast<double>(whole.size()));
  for (const Vec3d& p : less) EXPECT_GT(p.norm(), 0.28);
}

}  // namespace mesh_union_test
}  // namespace migiwa::testing
