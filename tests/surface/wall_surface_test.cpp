// The surface of liquid at walls: contact lines, wet faces, and γ's part in both.
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/surface/liquid_surface.h"
#include "core/walls/shapes.h"
#include "tests/surface/mesh_checks.h"

namespace migiwa {
namespace wall_surface_test {

using testing::crossingsOf;
using testing::faultsOf;

constexpr double kSpacing = 0.05;

struct Case {
  std::vector<Float4> positions;
  Boundary boundary;
};

SurfaceMesh surfaceOf(const Case& liquid) {
  ThreadPool pool(2);
  const auto support = static_cast<float>(2 * kSpacing);
  const PickedGamma gamma = makeGammaMethod(0, {liquid.boundary, KernelType::poly6, support});
  return liquidSurface({liquid.positions, {}, static_cast<float>(kSpacing), support},
                       {&liquid.boundary, gamma.method.get()}, {}, pool);
}

/// Vertices of wet triangles, and those of both kinds: the contact line.
struct Kinds {
  std::set<std::uint32_t> wet, contact;
};
Kinds kindsOf(const SurfaceMesh& mesh) {
  std::set<std::uint32_t> wet, free, both;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) (mesh.wet[t] != 0 ? wet : free).insert(v);
  for (const std::uint32_t v : wet)
    if (free.contains(v)) both.insert(v);
  return {wet, both};
}

/// Every wet vertex is on a wall, and no other is behind one.
void expectOnWalls(const SurfaceMesh& mesh, const Boundary& boundary) {
  const Kinds kinds = kindsOf(mesh);
  double farthest = 0, deepest = 0;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const double distance = static_cast<double>(boundary.distance(mesh.positions[v]));
    if (kinds.wet.contains(v)) farthest = std::max(farthest, std::abs(distance));
    deepest = std::min(deepest, distance);
  }
  EXPECT_LT(farthest, 0.001 * kSpacing);
  EXPECT_GT(deepest, -0.001 * kSpacing);
}

/// A tank with its lowest corner at the origin, filled by a lattice up to a height, turned as a whole.
Case filledTank(const Vec3d& size, double height, const Rotation& turn) {
  const Vec3d middle = 0.5 * size;
  const Eigen::Matrix3d axes = turn.matrix();
  Case result{{}, Boundary({std::make_shared<Box>(Vec3d::Zero(), size, Box::Fluid::inside, turn)})};
  for (double z = 0.5 * kSpacing; z < size.z(); z += kSpacing)
    for (double y = 0.5 * kSpacing; y < height; y += kSpacing)
      for (double x = 0.5 * kSpacing; x < size.x(); x += kSpacing)
        result.positions.emplace_back(Vec3d(middle + axes * (Vec3d(x, y, z) - middle)).cast<float>());
  return result;
}

Rotation rotation(const Vec3d& axis, double degrees) {
  Rotation turn;
  turn.axis = axis, turn.degrees = degrees;
  return turn;
}

TEST(WallSurface, OfAFullTankIsTheTank) {
  // Also where neither walls nor lattice lie along the grid.
  for (const double degrees : {0.0, 23.0}) {
    const Rotation turn = rotation(Vec3d(0.3, 0.5, 1).normalized(), degrees);
    const Vec3d size(0.8, 0.7, 0.6);
    const Case liquid = filledTank(size, 0.4, turn);
    const SurfaceMesh mesh = surfaceOf(liquid);
    EXPECT_EQ(faultsOf(mesh).total(), 0);
    EXPECT_EQ(crossingsOf(mesh, kSpacing, 0.005 * kSpacing), 0);
    expectOnWalls(mesh, liquid.boundary);
    EXPECT_NEAR(enclosedVolume(mesh) / (0.8 * 0.4 * 0.6), 1, 0.01) << degrees;

    // Flat, and as high at the walls as in the middle.
    const Kinds kinds = kindsOf(mesh);
    const Vec3d middle = 0.5 * size;
    double squares = 0, inside = 0, atWalls = 0;
    long free = 0, contact = 0;
    std::set<std::uint32_t> wet = kinds.wet;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3d local = turn.matrix().transpose() * (mesh.positions[v].cast<double>() - middle) + middle;
      if (kinds.contact.contains(v)) {
        atWalls += local.y(), ++contact;
      } else if (!wet.contains(v)) {
        inside += local.y(), squares += std::pow(local.y() - 0.4, 2), ++free;
      }
    }
    ASSERT_GT(free, 500);
    ASSERT_GT(contact, 50);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(free)), 0.05 * kSpacing) << degrees;
    EXPECT_NEAR(atWalls / static_cast<double>(contact), inside / static_cast<double>(free), 0.05 * kSpacing)
        << degrees;
    EXPECT_NEAR(inside / static_cast<double>(free), 0.4, 0.05 * kSpacing) << degrees;
  }
}

TEST(WallSurface, HasTheEdgesOfTheWalls) {
  // Vertices lie on the edges of the tank: chamfers would take volume and show in glass.
  const Case liquid = filledTank({0.8, 0.7, 0.6}, 0.4, {});
  const SurfaceMesh mesh = surfaceOf(liquid);
  long onFloorEdge = 0, corners = 0;
  for (const Vec3f& p : mesh.positions) {
    const auto on = [](float value, float wall) { return std::abs(value - wall) < 1e-5F; };
    const bool x = on(p.x(), 0) || on(p.x(), 0.8F), y = on(p.y(), 0), z = on(p.z(), 0) || on(p.z(), 0.6F);
    onFloorEdge += y && (x || z) ? 1 : 0;
    corners += x && y && z ? 1 : 0;
  }
  EXPECT_EQ(corners, 4);
  EXPECT_GE(onFloorEdge, static_cast<long>(2 * (0.8 + 0.6) / (0.5 * kSpacing)) - 8);
}

TEST(WallSurface, MeetsRoundWallsExactly) {
  // A spherical vessel, filled to a height: the cap's volume is known.
  Case liquid{{}, Boundary({std::make_shared<Sphere>(Vec3d(0.1, 0.2, 0.3), 0.5, Sphere::Fluid::inside)})};
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int shell = 0; shell < 10; ++shell) {
    const int count = static_cast<int>(
        std::lround(4 * std::numbers::pi / 3 * (std::pow(shell + 1, 3) - std::pow(shell, 3))));
    for (int k = 0; k < count; ++k) {
      const double y = 1 - (2 * k + 1.0) / count, across = std::sqrt(1 - y * y), turn = golden * k + shell;
      const Vec3d from =
          kSpacing * (shell + 0.5) * Vec3d(across * std::cos(turn), y, across * std::sin(turn));
      if (from.y() < 0) liquid.positions.emplace_back(Vec3d(Vec3d(0.1, 0.2, 0.3) + from).cast<float>());
    }
  }
  const SurfaceMesh mesh = surfaceOf(liquid);
  EXPECT_EQ(faultsOf(mesh).total(), 0);
  expectOnWalls(mesh, liquid.boundary);
  const Kinds kinds = kindsOf(mesh);
  EXPECT_GT(kinds.contact.size(), 60u);
  double level = 0;
  for (const std::uint32_t v : kinds.contact) level += mesh.positions[v].cast<double>().y();
  EXPECT_NEAR(enclosedVolume(mesh) / (2 * std::numbers::pi / 3 * std::pow(0.5, 3)), 1, 0.02);
  EXPECT_NEAR(level / static_cast<double>(kinds.contact.size()), 0.2, 0.3 * kSpacing);
}

TEST(WallSurface, OfADropOnAPlateIsWetBelow) {
  Case liquid{{}, Boundary({std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY())})};
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i)
        liquid.positions.emplace_back(Vec3d(kSpacing * Vec3d(i + 0.5, j + 0.5, k + 0.5)).cast<float>());
  const SurfaceMesh mesh = surfaceOf(liquid);
  EXPECT_EQ(faultsOf(mesh).total(), 0);
  expectOnWalls(mesh, liquid.boundary);
  double wetArea = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d area =
        0.5 *
        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).cast<double>();
    if (mesh.wet[t] == 0) continue;
    wetArea += area.norm();
    EXPECT_LE(area.y(), -0.999 * area.norm() + 1e-9);
  }
  EXPECT_NEAR(wetArea / (36 * kSpacing * kSpacing), 1, 0.1);
}

TEST(WallSurface, AroundASolidInTheLiquidIsItsSurface) {
  // A block and a ball in a full tank: the volume lacks theirs.
  Case liquid = filledTank({0.8, 0.6, 0.6}, 0.5, {});
  auto tank = liquid.boundary.surfaces().front();
  const Vec3d low(0.1, 0.1, 0.15), high(0.25, 0.3, 0.4), center(0.55, 0.25, 0.3);
  liquid.boundary = Boundary({tank, std::make_shared<Box>(low, high, Box::Fluid::outside),
                              std::make_shared<Sphere>(center, 0.15, Sphere::Fluid::outside)});
  std::erase_if(liquid.positions, [&](const Float4& p) { return liquid.boundary.distance(p.xyz()) < 0.02F; });
  const SurfaceMesh mesh = surfaceOf(liquid);
  EXPECT_EQ(faultsOf(mesh).total(), 0);
  EXPECT_EQ(crossingsOf(mesh, kSpacing, 0.005 * kSpacing), 0);
  expectOnWalls(mesh, liquid.boundary);
  const double solid = (high - low).prod() + 4 * std::numbers::pi / 3 * std::pow(0.15, 3);
  EXPECT_NEAR(enclosedVolume(mesh) / (0.8 * 0.5 * 0.6 - solid), 1, 0.01);
}

}  // namespace wall_surface_test
}  // namespace migiwa
