// The surface of liquid without walls.
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/surface/liquid_surface.h"
#include "tests/surface/mesh_checks.h"

namespace migiwa {
namespace free_surface_test {

using testing::crossingsOf;
using testing::faultsOf;

constexpr double kSpacing = 0.05;

SurfaceMesh surfaceOf(const std::vector<Float4>& positions, const SurfaceOptions& options = {},
                      int threads = 2, std::span<const Float4> velocities = {}) {
  ThreadPool pool(threads);
  return liquidSurface(
      {positions, velocities, static_cast<float>(kSpacing), static_cast<float>(2 * kSpacing)}, {}, options,
      pool);
}

/// A ball as it is at rest under surface tension: shells a spacing apart, each with its volume's number of
/// particles.
std::vector<Float4> ball(int shells, const Vec3d& center = Vec3d::Zero()) {
  std::vector<Float4> positions;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int shell = 0; shell < shells; ++shell) {
    const double radius = shell + 0.5;
    const int count = static_cast<int>(
        std::lround(4 * std::numbers::pi / 3 * (std::pow(shell + 1, 3) - std::pow(shell, 3))));
    for (int k = 0; k < count; ++k) {
      const double z = 1 - (2 * k + 1.0) / count, across = std::sqrt(1 - z * z), turn = golden * k + shell;
      positions.emplace_back(
          Vec3d(center + kSpacing * radius * Vec3d(across * std::cos(turn), across * std::sin(turn), z))
              .cast<float>());
    }
  }
  return positions;
}

std::vector<Float4> cloud(unsigned seed, int count, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0, static_cast<float>(size));
  std::vector<Float4> positions;
  for (int k = 0; k < count; ++k) {
    const float x = place(random), y = place(random), z = place(random);
    positions.emplace_back(x, y, z);
  }
  return positions;
}

double volumeOf(const std::vector<Float4>& positions) {
  return static_cast<double>(positions.size()) * kSpacing * kSpacing * kSpacing;
}

TEST(FreeSurface, OfABallIsASphere) {
  for (const int shells : {8, 12}) {
    const std::vector<Float4> positions = ball(shells, {0.013, -0.021, 0.007});
    const SurfaceMesh mesh = surfaceOf(positions);
    EXPECT_EQ(faultsOf(mesh).total(), 0);
    EXPECT_EQ(crossingsOf(mesh, kSpacing, 1e-3 * kSpacing), 0);
    const double radius = shells * kSpacing;
    double farthest = 0, worstNormal = 1;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3d from = mesh.positions[v].cast<double>() - Vec3d(0.013, -0.021, 0.007);
      farthest = std::max(farthest, std::abs(from.norm() - radius));
      worstNormal = std::min(worstNormal, mesh.normals[v].cast<double>().dot(from.normalized()));
    }
    EXPECT_LT(farthest, 0.1 * kSpacing) << shells;
    EXPECT_GT(worstNormal, 0.95) << shells;
    EXPECT_NEAR(enclosedVolume(mesh) / (4 * std::numbers::pi / 3 * std::pow(radius, 3)), 1, 0.01) << shells;
    EXPECT_NEAR(enclosedVolume(mesh) / volumeOf(positions), 1, 0.01) << shells;
  }
}

TEST(FreeSurface, OfRandomParticlesIsClosedAndManifold) {
  // From single drops to a block with holes: every way in which corners of cells can be in the water.
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const std::vector<Float4> positions = cloud(seed, static_cast<int>(40 * seed), 0.5);
    for (const double resolution : {0.5, 1.0}) {
      SurfaceOptions options;
      options.resolution = resolution;
      const SurfaceMesh mesh = surfaceOf(positions, options);
      ASSERT_FALSE(mesh.empty());
      EXPECT_EQ(faultsOf(mesh).total(), 0) << seed << ' ' << resolution;
      EXPECT_LE(crossingsOf(mesh, kSpacing, 0.02 * kSpacing), 0) << seed << ' ' << resolution;
      EXPECT_GT(enclosedVolume(mesh), 0);
    }
  }
}

TEST(FreeSurface, KeepsSingleDropletsOrDropsThem) {
  std::vector<Float4> positions = ball(8);
  positions.emplace_back(1.0F, 0.0F, 0.0F);
  positions.emplace_back(2.0F, 0.0F, 0.0F);
  positions.emplace_back(2.0F + static_cast<float>(kSpacing), 0.0F, 0.0F);
  const auto near = [](const SurfaceMesh& mesh, const Vec3d& p) {
    long count = 0;
    for (const Vec3f& v : mesh.positions) count += (v.cast<double>() - p).norm() < 2 * kSpacing ? 1 : 0;
    return count;
  };
  const SurfaceMesh all = surfaceOf(positions);
  EXPECT_GT(near(all, {1, 0, 0}), 6);
  EXPECT_GT(near(all, {2, 0, 0}), 6);
  SurfaceOptions options;
  options.smallest = 3;
  const SurfaceMesh large = surfaceOf(positions, options);
  EXPECT_EQ(near(large, {1, 0, 0}), 0);
  EXPECT_EQ(near(large, {2, 0, 0}), 0);
  EXPECT_EQ(faultsOf(large).total(), 0);
  EXPECT_NEAR(enclosedVolume(large) / (4 * std::numbers::pi / 3 * std::pow(8 * kSpacing, 3)), 1, 0.01);
}

TEST(FreeSurface, OfOneParticleIsADropAboutIt) {
  // Wherever it lies between the nodes; its own radius is 0.62 spacings.
  for (const float x : {0.0F, 0.011F, 0.0125F, 0.02F}) {
    const SurfaceMesh mesh = surfaceOf({Float4(x, 0.3F, -0.2F)});
    EXPECT_EQ(faultsOf(mesh).total(), 0);
    ASSERT_FALSE(mesh.empty());
    for (const Vec3f& p : mesh.positions) {
      const double radius = (p - Vec3f(x, 0.3F, -0.2F)).cast<double>().norm() / kSpacing;
      EXPECT_GT(radius, 0.35);
      EXPECT_LT(radius, 0.75);
    }
  }
}

TEST(FreeSurface, IsEmptyWithoutParticlesAndLeavesOutWhatIsNowhere) {
  EXPECT_TRUE(surfaceOf({}).empty());
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(surfaceOf({Float4(nan, 0, 0)}).empty());
  std::vector<Float4> positions = ball(4);
  const SurfaceMesh mesh = surfaceOf(positions);
  positions.emplace_back(0.0F, nan, 0.0F);
  positions.emplace_back(infinite, 0.0F, 0.0F);
  EXPECT_EQ(surfaceOf(positions).positions, mesh.positions);
}

TEST(FreeSurface, MovesWithParticlesThatMoveByACell) {
  // The grid is fixed: a move by whole cells, here one that floats hold exactly, is one of the mesh.
  std::vector<Float4> positions = cloud(5, 300, 0.4);
  for (Float4& p : positions)
    p = {std::round(p.x * 4096) / 4096, std::round(p.y * 4096) / 4096, std::round(p.z * 4096) / 4096};
  const auto shifted = [&](const Vec3f& by) {
    std::vector<Float4> result;
    for (const Float4& p : positions) result.emplace_back(Vec3f(p.xyz() + by));
    return result;
  };
  const auto surface = [](const std::vector<Float4>& at) {
    ThreadPool pool(2);
    return liquidSurface({at, {}, 0.0625F, 0.125F}, {}, {}, pool);
  };
  const SurfaceMesh mesh = surface(positions);
  const Vec3f cell(0.03125F, -0.0625F, 0.3125F);
  const SurfaceMesh moved = surface(shifted(cell));
  ASSERT_EQ(moved.positions.size(), mesh.positions.size());
  // Blocks hold other cells, so vertices come in another order.
  const auto inOrder = [](std::vector<Vec3f> points) {
    std::sort(points.begin(), points.end(), [](const Vec3f& a, const Vec3f& b) {
      return std::array{std::round(a.x() * 1e4F), std::round(a.y() * 1e4F), a.z()} <
             std::array{std::round(b.x() * 1e4F), std::round(b.y() * 1e4F), b.z()};
    });
    return points;
  };
  std::vector<Vec3f> back = moved.positions;
  for (Vec3f& p : back) p -= cell;
  const std::vector<Vec3f> here = inOrder(mesh.positions), there = inOrder(back);
  long off = 0;
  for (std::size_t v = 0; v < here.size(); ++v) off += (here[v] - there[v]).norm() > 2e-4F ? 1 : 0;
  EXPECT_LE(off, static_cast<long>(here.size() / 200));  // those that rounding has put into another order
}

TEST(FreeSurface, GoesWithTheParticlesVelocities) {
  const std::vector<Float4> positions = ball(6);
  std::vector<Float4> velocities;
  for (const Float4& p : positions) velocities.emplace_back(1 + 2 * p.x, -1.0F, 3 * p.y);
  const SurfaceMesh mesh = surfaceOf(positions, {}, 2, velocities);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    // A vertex sees particles on one side of it, within two spacings.
    const Vec3f& p = mesh.positions[v];
    const float near = static_cast<float>(kSpacing);
    EXPECT_NEAR(mesh.velocities[v].x(), 1 + 2 * p.x(), 2 * near);
    EXPECT_NEAR(mesh.velocities[v].y(), -1, 1e-5);
    EXPECT_NEAR(mesh.velocities[v].z(), 3 * p.y(), 3 * near);
  }
}

bool sameBytes(const SurfaceMesh& a, const SurfaceMesh& b) {
  const auto same = [](const auto& one, const auto& other) {
    return one.size() == other.size() &&
           (one.empty() || std::memcmp(one.data(), other.data(), one.size() * sizeof one[0]) == 0);
  };
  return same(a.positions, b.positions) && same(a.normals, b.normals) && same(a.velocities, b.velocities) &&
         same(a.triangles, b.triangles) && same(a.wet, b.wet);
}

TEST(SurfaceThreads, AndTheOrderOfParticlesDoNotMatter) {
  std::vector<Float4> positions = cloud(3, 2000, 0.8);
  const SurfaceMesh one = surfaceOf(positions, {}, 1, positions);
  for (const int threads : {2, 4})
    EXPECT_TRUE(sameBytes(surfaceOf(positions, {}, threads, positions), one)) << threads;
  std::reverse(positions.begin(), positions.end());
  EXPECT_TRUE(sameBytes(surfaceOf(positions, {}, 2, positions), one));
}

}  // namespace free_surface_test
}  // namespace migiwa
