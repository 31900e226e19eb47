// gamma as sums over the edges of facets, against quadratures of its definition that share no code with it:
// rims, edges and corners of blocks, oblique wedges, meshes, and parts that hide each other.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/gamma/batches.h"
#include "core/gamma/gamma_method.h"
#include "core/walls/mesh_wall.h"
#include "core/walls/shapes.h"
#include "tests/gamma/gamma_reference.h"

namespace migiwa {
namespace gamma_facets_test {

using Surfaces = std::vector<std::shared_ptr<const Surface>>;

using reference::kKernels;
using reference::kSupport;

/// Places in support radii as points in metres.
std::vector<Float4> pointsAt(const std::vector<Vec3d>& places) {
  std::vector<Float4> points;
  points.reserve(places.size());
  for (const Vec3d& p : places) points.emplace_back((kSupport * p).cast<float>());
  return points;
}

std::vector<GammaSample> samplesOf(const Boundary& boundary, std::string_view method, KernelType kernel,
                                   const std::vector<Vec3d>& places, int directions = 1024) {
  const auto names = gammaMethodNames();
  const auto index = static_cast<int>(std::find(names.begin(), names.end(), method) - names.begin());
  const PickedGamma picked =
      makeGammaMethod(index, {boundary, kernel, static_cast<float>(kSupport), directions});
  const std::vector<Float4> points = pointsAt(places);
  std::vector<GammaSample> samples(points.size());
  picked.method->evaluate(points, samples);
  return samples;
}

/// Points (in support radii) that are in reach of a wall, and not nearer than a tenth of it.
std::vector<Vec3d> pointsNear(const Boundary& boundary, std::size_t count, const Vec3d& low,
                              const Vec3d& high) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3d> points;
  for (int attempt = 0; points.size() < count && attempt < 100000; ++attempt) {
    const Vec3d p = low + Vec3d(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    const double distance = static_cast<double>(boundary.distance((kSupport * p).cast<float>())) / kSupport;
    if (distance > 0.1 && distance < 0.95) points.push_back(p);
  }
  EXPECT_EQ(points.size(), count);
  return points;
}

/// Errors of gamma, and of h grad gamma for the density kernel and for that of the pair gradients.
struct Errors {
  double gamma = 0, gradient = 0, pairGradient = 0;
};

/// Along a ray that ends at r, 4 pi integral_r^1 W'(s) s^2 ds: its share of h grad gamma, which is the
/// integral of the kernel's gradient over the fluid that is seen.
class SlopeTable {
 public:
  explicit SlopeTable(KernelType type) {
    const auto shell = [&](double s) { return s * reference::kernel(type, s); };
    for (int k = 0; k <= kCells; ++k) {
      const double r = static_cast<double>(k) / kCells, knee = std::max(r, 0.5);
      const double outer = quadrature::integrate(knee, 1, 2, shell),
                   inner = r < 0.5 ? quadrature::integrate(r, 0.5, 2, shell) : 0;
      values_.push_back(4 * std::numbers::pi * (-r * r * reference::kernel(type, r) - 2 * (inner + outer)));
    }
  }
  double operator()(double r) const { return r >= 1 ? 0 : reference::interpolate(values_, r * kCells); }

 private:
  static constexpr int kCells = 1024;
  std::vector<double> values_;
};

/// Against quadratures over all directions. `fluid(table, p, w)` is what the fluid holds along a direction w
/// from p, for the table of what a ray holds up to its end.
template <class Fluid>
Errors errorsOf(const std::string& name, const Boundary& boundary, KernelType kernel,
                const std::vector<Vec3d>& points, std::size_t gammas, std::size_t gradients,
                const Fluid& fluid) {
  const reference::MassTable mass(kernel);
  const SlopeTable slope(kernel), pairSlope(kernel == KernelType::poly6 ? KernelType::spiky : kernel);
  const std::vector<GammaSample> samples = samplesOf(boundary, "facets", kernel, points);
  Errors errors;
  for (std::size_t k = 0; k < gammas; ++k) {
    const double truth =
        reference::overDirections([&](const Vec3d& w) { return fluid(mass, points[k], w); }, 1e-6);
    errors.gamma = std::max(errors.gamma, std::abs(static_cast<double>(samples[k].gamma) - truth));
    if (k >= gradients) continue;
    const auto gradientOf = [&](const SlopeTable& table) {
      Vec3d gradient;
      for (int axis = 0; axis < 3; ++axis)
        gradient[axis] = reference::overDirections(
            [&](const Vec3d& w) { return w[axis] * fluid(table, points[k], w); }, 1e-5);
      return gradient;
    };
    errors.gradient =
        std::max(errors.gradient, (samples[k].gradient.cast<double>() - gradientOf(slope)).norm());
    errors.pairGradient = std::max(errors.pairGradient,
                                   (samples[k].pairGradient.cast<double>() - gradientOf(pairSlope)).norm());
  }
  // How far off fixed directions are.
  Errors directions;
  const std::vector<GammaSample> others = samplesOf(boundary, "directions", kernel, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    directions.gamma =
        std::max(directions.gamma, std::abs(static_cast<double>(others[k].gamma - samples[k].gamma)));
    directions.gradient =
        std::max(directions.gradient, static_cast<double>((others[k].gradient - samples[k].gradient).norm()));
  }
  std::printf(
      "%-30s %-12s gamma %.5f  gradient %.4f  pair %.4f  1024 directions: gamma %.4f  gradient %.3f\n",
      name.c_str(), std::string(kKernelNames[static_cast<std::size_t>(kernel)]).c_str(), errors.gamma,
      errors.gradient, errors.pairGradient, directions.gamma, directions.gradient);
  return errors;
}

/// Some boxes, in support radii, that hide all behind them.
struct BoxAt {
  Vec3d low, high;
};

Boundary boundaryOf(const std::vector<BoxAt>& boxes, const Surfaces& more = {}) {
  Surfaces surfaces = more;
  for (const BoxAt& box : boxes)
    surfaces.push_back(std::make_shared<Box>(kSupport * box.low, kSupport * box.high, Box::Fluid::outside));
  return Boundary(surfaces);
}

double firstOf(const std::vector<BoxAt>& boxes, const Vec3d& p, const Vec3d& w) {
  double first = 1;
  for (const BoxAt& box : boxes) first = std::min(first, reference::entryOf(box.low, box.high, p, w));
  return first;
}

void expectThin(const std::string& name, const std::vector<BoxAt>& boxes, const Surfaces& more,
                const std::vector<reference::PlaneAt>& planes, const Vec3d& low, const Vec3d& high,
                double gammaBound = 3e-5, double gradientBound = 3e-4) {
  const Boundary boundary = boundaryOf(boxes, more);
  const std::vector<Vec3d> points = pointsNear(boundary, 30, low, high);
  for (const KernelType kernel : kKernels) {
    SCOPED_TRACE(name);
    const auto fluid = [&](const auto& table, const Vec3d& p, const Vec3d& w) {
      double hit = firstOf(boxes, p, w);
      for (const reference::PlaneAt& plane : planes)
        hit = std::min(hit, reference::hitOf({plane.normal, plane.normal.dot(p) - plane.distance}, w));
      return table(hit);
    };
    const bool main = kernel == KernelType::poly6;
    const Errors errors = errorsOf(name, boundary, kernel, points, main ? 4 : 1, main ? 2 : 1, fluid);
    EXPECT_LT(errors.gamma, gammaBound);
    EXPECT_LT(errors.gradient, gradientBound);
    EXPECT_LT(errors.pairGradient, gradientBound);
  }
}

TEST(GammaFacets, RimsOfAThinPlate) {
  expectThin("rim of a plate", {{{-3, -0.25, -3}, {0, 0, 3}}}, {}, {}, {-0.8, -0.9, -0.5}, {0.8, 0.8, 0.5});
  expectThin("corner of a plate", {{{-3, -0.25, -3}, {0, 0, 0}}}, {}, {}, {-0.8, -0.9, -0.8},
             {0.8, 0.8, 0.8});
}

TEST(GammaFacets, PostsAndWhatStandsBehindThem) {
  expectThin("post", {{{-0.2, -3, -0.2}, {0.2, 3, 0.2}}}, {}, {}, {-1, -1, -1}, {1, 1, 1});
  expectThin("small block", {{{-0.2, -0.3, -0.2}, {0.2, 0.1, 0.3}}}, {}, {}, {-1, -1, -1}, {1, 1, 1});
  expectThin("two posts side by side", {{{-0.5, -3, -0.2}, {-0.2, 3, 0.2}}, {{0.2, -3, -0.2}, {0.5, 3, 0.3}}},
             {}, {}, {-1, -0.5, -1}, {1, 0.5, 1});
  expectThin("three blocks in a row",
             {{{-0.3, -0.2, -0.3}, {0.3, 0.4, -0.1}},
              {{-0.1, -0.3, 0.1}, {0.4, 0.2, 0.2}},
              {{-0.4, 0.1, 0.35}, {0.2, 0.5, 0.5}}},
             {}, {}, {-0.6, -0.6, -0.9}, {0.6, 0.6, 0.9});
}

TEST(GammaFacets, PostsOnAFloorAndInACorner) {
  const auto floor = std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY());
  const auto wall = std::make_shared<Plane>(Vec3d(-0.6 * kSupport, 0, 0), Vec3d(1, 0, 0.2));
  const Vec3d inwards = Vec3d(1, 0, 0.2).normalized();
  expectThin("post on a floor", {{{-0.2, 0, -0.2}, {0.2, 2, 0.2}}}, {floor}, {{Vec3d::UnitY(), 0}},
             {-1, 0, -1}, {1, 0.8, 1});
  expectThin("post through a floor, at a wall", {{{-0.2, -0.3, -0.2}, {0.2, 0.5, 0.2}}}, {floor, wall},
             {{Vec3d::UnitY(), 0}, {inwards, -0.6 * inwards.x()}}, {-0.6, 0, -1}, {1, 0.9, 1});
}

TEST(GammaFacets, InThePlaneOfAFaceThatFaceHidesNothing) {
  const std::vector<BoxAt> boxes{{{0, -3, -1.1}, {0.33, 1.2, -0.76}}, {{0, -3, 0.51}, {0.46, 1.2, 0.97}}};
  const std::vector<Vec3d> points{{3e-4, 0, 0}, {1e-4, 0.2, 0.1}, {-2e-4, 0, 0}, {0.33, 0, 0.05}};
  const auto fluid = [&](const auto& table, const Vec3d& p, const Vec3d& w) {
    return table(firstOf(boxes, p, w));
  };
  const Errors errors =
      errorsOf("in a face's plane", boundaryOf(boxes), KernelType::poly6, points, 4, 0, fluid);
  EXPECT_LT(errors.gamma, 1e-3);
}

/// What the short way about upright blocks gives, where it gives something, is what facets give to the last
/// bit. Returns the share of points for which it does; it leaves those that only a floor is in reach of.
double shareOfTheShortWay(const std::vector<BoxAt>& boxes, const Surfaces& more, KernelType kernel) {
  const Boundary boundary = boundaryOf(boxes, more);
  const std::vector<Vec3d> places = pointsNear(boundary, 640, {-1.2, 0, -1.2}, {1.2, 1.2, 1.2});
  const std::vector<Float4> points = pointsAt(places);
  std::vector<GammaSample> found(points.size());
  std::vector<std::size_t> others;
  makeBlockGamma({boundary, kernel, static_cast<float>(kSupport)})->evaluate(points, found, others);
  const std::vector<GammaSample> expected = samplesOf(boundary, "facets", kernel, places);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_EQ(found[k].distance, expected[k].distance);
    if (std::find(others.begin(), others.end(), k) != others.end()) continue;
    EXPECT_EQ(found[k].gamma, expected[k].gamma) << places[k].transpose();
    EXPECT_EQ(found[k].gradient, expected[k].gradient) << places[k].transpose();
    EXPECT_EQ(found[k].pairGradient, expected[k].pairGradient) << places[k].transpose();
  }
  return 1 - static_cast<double>(others.size()) / static_cast<double>(points.size());
}

TEST(GammaFacets, AboutUprightBlocksTheShortWayIsTheSameToTheLastBit) {
  const auto floor = std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY());
  const auto tank = std::make_shared<Box>(kSupport * Vec3d(-1.5, 0, -1.5), kSupport * Vec3d(1.5, 3, 1.5),
                                          Box::Fluid::inside);
  const std::vector<BoxAt> post{{{-0.2, 0, -0.2}, {0.2, 2, 0.2}}},
      posts{{{-0.9, 0, -0.9}, {-0.6, 2, -0.5}},
            {{0.5, 0, -0.8}, {0.9, 0.7, -0.4}},
            {{-0.2, 0, 0.6}, {0.2, 2, 0.9}}},
      cubes{{{-0.9, 0.2, -0.9}, {-0.6, 0.5, -0.5}},
            {{0.1, 0.6, -0.1}, {0.4, 0.9, 0.2}},
            {{0.6, 0.1, 0.5}, {0.8, 0.3, 0.8}}};
  for (const KernelType kernel : kKernels) {
    EXPECT_GT(shareOfTheShortWay(post, {}, kernel), 0.95);
    EXPECT_GT(shareOfTheShortWay(post, {floor}, kernel), 0.8);
    EXPECT_GT(shareOfTheShortWay(posts, {tank}, kernel), 0.8);
    EXPECT_GT(shareOfTheShortWay(cubes, {}, kernel), 0.8);
  }
  // One that stands before another is left to facets, and so is one that is turned or thick.
  EXPECT_LT(shareOfTheShortWay({{{-0.5, -3, 0.2}, {0.5, 3, 0.3}}, {{-0.5, -3, 0.5}, {0.5, 3, 0.6}}}, {},
                               KernelType::poly6),
            0.8);
}

TEST(GammaFacets, ObliqueWedges) {
  for (const KernelType kernel : kKernels) {
    const reference::Wedge wedge(kernel);
    for (const double degrees : {30.0, 60.0, 90.0, 120.0, 150.0}) {
      const double angle = degrees * std::numbers::pi / 180;
      const Vec3d first(0, 1, 0), second(std::sin(angle), -std::cos(angle), 0);
      const Boundary boundary(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), first),
                                       std::make_shared<Plane>(Vec3d::Zero(), second)});
      const std::vector<Vec3d> points = pointsNear(boundary, 20, {-1, 0, 0}, {1, 1, 0});
      const std::vector<GammaSample> samples = samplesOf(boundary, "facets", kernel, points);
      const auto truth = [&](const Vec3d& p) {
        return wedge.gamma(first, first.dot(p), second, second.dot(p), true);
      };
      for (std::size_t k = 0; k < points.size(); ++k) {
        EXPECT_NEAR(static_cast<double>(samples[k].gamma), truth(points[k]), 2e-5) << degrees;
        EXPECT_LT((samples[k].gradient.cast<double>() - reference::gradientOf(truth, points[k])).norm(), 1e-3)
            << degrees;
      }
    }
  }
}

TEST(GammaFacets, AtAnEdgeItIsTheAngleAndBehindAWallItGoesOn) {
  const auto block = std::make_shared<Box>(Vec3d(-1, -1, -1), Vec3d(0, 0, 0), Box::Fluid::outside);
  const auto tank = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(1, 1, 1), Box::Fluid::inside);
  for (const KernelType kernel : kKernels) {
    const auto gammaAt = [&](const std::shared_ptr<const Surface>& wall, const Vec3d& p) {
      return samplesOf(Boundary(Surfaces{wall}), "facets", kernel, {p}).front().gamma;
    };
    EXPECT_NEAR(gammaAt(block, {0, 0, -3}), 0.75F, 3e-5F);
    EXPECT_NEAR(gammaAt(block, {0, -3, -3}), 0.5F, 1e-5F);
    EXPECT_NEAR(gammaAt(block, {0, 0, 0}), 0.875F, 2e-4F);
    EXPECT_NEAR(gammaAt(tank, {0, 0, 5}), 0.25F, 3e-5F);
    EXPECT_NEAR(gammaAt(tank, {0, 0, 0}), 0.125F, 2e-4F);
    const float behind = gammaAt(block, {-0.01, -3, -3}) - 0.5F;
    EXPECT_NEAR(behind, gammaAt(block, {0, -3, -3}) - gammaAt(block, {0.01, -3, -3}), 1e-4F);
  }
}

// Meshes, in support radii, against rays that are cast at their triangles one by one.

TriangleMesh scaled(const std::vector<Vec3d>& places, std::vector<std::array<std::uint32_t, 3>> triangles) {
  TriangleMesh mesh;
  for (const Vec3d& p : places) mesh.vertices.emplace_back((kSupport * p).cast<float>());
  mesh.triangles = std::move(triangles);
  return mesh;
}

TriangleMesh boxMesh(const Vec3d& low, const Vec3d& high) {
  TriangleMesh mesh;
  Box(kSupport * low, kSupport * high, Box::Fluid::outside).enclosed(mesh);
  return mesh;
}

TriangleMesh together(const TriangleMesh& one, const TriangleMesh& other) {
  TriangleMesh mesh = one;
  const auto first = static_cast<std::uint32_t>(one.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

TriangleMesh tetrahedron(double size) {
  return scaled({{size, size, size}, {size, -size, -size}, {-size, size, -size}, {-size, -size, size}},
                {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

/// A tube along y of 20 sides, with an inside; without thickness it is a sheet.
TriangleMesh tube(double inner, double outer, double half) {
  constexpr std::uint32_t kSides = 20;
  std::vector<Vec3d> places;
  // Four rings: inside from top to bottom, outside from bottom to top.
  const std::array<std::pair<double, double>, 4> rings{
      {{inner, half}, {inner, -half}, {outer, -half}, {outer, half}}};
  const std::uint32_t count = outer > inner ? 4 : 2;
  for (std::uint32_t ring = 0; ring < count; ++ring)
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      places.emplace_back(rings[ring].first * std::cos(angle), rings[ring].second,
                          rings[ring].first * std::sin(angle));
    }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t ring = 0; ring < (count == 4 ? 4 : 1); ++ring)
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = ring * kSides + k, b = ring * kSides + (k + 1) % kSides,
                          c = (ring + 1) % count * kSides + k,
                          d = (ring + 1) % count * kSides + (k + 1) % kSides;
      triangles.push_back({a, d, b});
      triangles.push_back({a, c, d});
    }
  return scaled(places, triangles);
}

std::shared_ptr<const TriangleWall> wallOf(const TriangleMesh& mesh) {
  return std::make_shared<TriangleWall>(std::make_shared<const TriangleTree>(wallFaces(mesh, false, "mesh")),
                                        false, static_cast<float>(kSupport));
}

/// A triangle in support radii.
struct Triangle {
  std::array<Vec3d, 3> corners;
  bool sheet;
};

std::vector<Triangle> trianglesOf(const TriangleWall& wall) {
  std::vector<Triangle> triangles;
  for (const WallTriangle& triangle : wall.tree()->triangles()) {
    triangles.push_back({{}, triangle.sheet});
    for (std::size_t k = 0; k < 3; ++k)
      triangles.back().corners[k] = triangle.corners[k].cast<double>() / kSupport;
  }
  return triangles;
}

/// Where a ray meets the triangles, with +1 where it enters the solid, -1 where it leaves it.
std::vector<std::pair<double, int>> crossingsOf(const std::vector<Triangle>& triangles, const Vec3d& p,
                                                const Vec3d& w) {
  std::vector<std::pair<double, int>> crossings;
  for (const Triangle& triangle : triangles) {
    const std::array<Vec3d, 3> to{triangle.corners[0] - p, triangle.corners[1] - p, triangle.corners[2] - p};
    const double u = w.dot(to[1].cross(to[2])), v = w.dot(to[2].cross(to[0])), s = w.dot(to[0].cross(to[1]));
    if ((u < 0 || v < 0 || s < 0) && (u > 0 || v > 0 || s > 0)) continue;
    const double sum = u + v + s;
    if (sum == 0) continue;
    const double at = (u * to[0] + v * to[1] + s * to[2]).dot(w) / sum;
    if (at > 0 && at < 1) crossings.emplace_back(at, triangle.sheet || sum < 0 ? 1 : -1);
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}

void expectMesh(const std::string& name, const TriangleMesh& mesh, bool thin, double reach,
                double gammaBound = 1e-4) {
  const auto wall = wallOf(mesh);
  const Boundary boundary(Surfaces{wall});
  const std::vector<Triangle> triangles = trianglesOf(*wall);
  const std::vector<Vec3d> points = pointsNear(boundary, 20, Vec3d::Constant(-reach), Vec3d::Constant(reach));
  for (const KernelType kernel : {KernelType::poly6, KernelType::wendlandC2}) {
    SCOPED_TRACE(name);
    const auto fluid = [&](const auto& table, const Vec3d& p, const Vec3d& w) {
      double held = table(1);
      for (const auto& [at, sign] : crossingsOf(triangles, p, w)) {
        if (thin) return table(at);
        held -= sign * (table(1) - table(at));
      }
      return held;
    };
    const bool main = kernel == KernelType::poly6;
    const Errors errors = errorsOf(name, boundary, kernel, points, main ? 3 : 1, main ? 2 : 1, fluid);
    EXPECT_LT(errors.gamma, gammaBound);
    EXPECT_LT(errors.gradient, 5e-4);
    EXPECT_LT(errors.pairGradient, 5e-4);
  }
}

TEST(GammaFacets, MeshesThatHide) {
  expectMesh("mesh of a thin box", boxMesh({-0.3, -0.4, -0.1}, {0.3, 0.4, 0.1}), true, 1);
  expectMesh("tube of 20 sides", tube(0.5, 0.6, 0.4), true, 1.2);
  expectMesh("sheet of 20 sides", tube(0.5, 0.5, 0.4), true, 1.2);
}

TEST(GammaFacets, MeshesThatAreThickAreWhatTheyEnclose) {
  expectMesh("mesh of a box", boxMesh({-1, -1, -1}, {0.5, 0.6, 0.7}), false, 1.5);
  expectMesh("tetrahedron", tetrahedron(0.3), false, 1);
  expectMesh("large tetrahedron", tetrahedron(2.5), false, 3);
  // Rays that have left one part enter the other.
  expectMesh("two parts", together(boxMesh({-2, -2, -2}, {-0.2, 0, 2}), boxMesh({0.2, -2, -2}, {2, 0.3, 2})),
             false, 1.2);
}

}  // namespace gamma_facets_test
}  // namespace migiwa
