// What holds of gamma for any wall, at random places.
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "core/gamma/gamma_method.h"
#include "core/walls/shapes.h"
#include "tests/gamma/gamma_reference.h"

namespace migiwa {
namespace gamma_properties_test {

using Surfaces = std::vector<std::shared_ptr<const Surface>>;

using reference::kKernels;
constexpr auto kSupport = static_cast<float>(reference::kSupport);

PickedGamma make(const Boundary& boundary, std::string_view method, KernelType kernel = KernelType::poly6) {
  const auto names = gammaMethodNames();
  const auto index = static_cast<int>(std::find(names.begin(), names.end(), method) - names.begin());
  Bounds region;  // of all the points below
  region.include(Vec3d::Constant(-0.25));
  region.include(Vec3d::Constant(0.25));
  return makeGammaMethod(index, {boundary, kernel, kSupport, 1024, 1000, region});
}

std::vector<GammaSample> evaluate(const GammaMethod& method, const std::vector<Vec3f>& points) {
  std::vector<Float4> at;
  for (const Vec3f& p : points) at.emplace_back(p);
  std::vector<GammaSample> samples(at.size());
  method.evaluate(at, samples);
  return samples;
}

/// Walls of all kinds, all within a ball of 0.5 about the origin.
struct Scenery {
  const char* name;
  Boundary boundary;
};
std::vector<Scenery> sceneries() {
  const auto tank =
      std::make_shared<Box>(Vec3d(-0.3, -0.25, -0.3), Vec3d(0.3, 0.25, 0.3), Box::Fluid::inside);
  std::vector<Scenery> all;
  all.push_back({"tank", Boundary(Surfaces{tank})});
  all.push_back({"wedge", Boundary(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), Vec3d(0, 1, 0)),
                                            std::make_shared<Plane>(Vec3d::Zero(), Vec3d(0.8, -0.6, 0))})});
  all.push_back({"block", Boundary(Surfaces{
                              tank, std::make_shared<Box>(Vec3d(-0.1, -0.25, -0.06), Vec3d(0.05, 0, 0.08),
                                                          Box::Fluid::outside, Rotation{{0, 1, 0}, 30})})});
  all.push_back(
      {"ball in a tank",
       Boundary(Surfaces{tank, std::make_shared<Sphere>(Vec3d(0, -0.1, 0), 0.12, Sphere::Fluid::outside)})});
  all.push_back(
      {"vessel", Boundary(Surfaces{std::make_shared<Sphere>(Vec3d::Zero(), 0.3, Sphere::Fluid::inside)})});
  all.push_back({"bowl", Boundary(Surfaces{std::make_shared<Polynomial>(
                             Vec3d::Zero(), Vec3d::UnitZ(), Vec3d::UnitX(), 0.4,
                             std::vector<Polynomial::Term>{{2, 0, 2.5}, {0, 2, 1.25}})})});
  return all;
}

/// Fluid points of a scenery within `most` of its walls.
std::vector<Vec3f> fluidPoints(const Boundary& boundary, std::size_t count, float most = kSupport) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> coordinate(-0.24F, 0.24F);
  std::vector<Vec3f> points;
  while (points.size() < count) {
    const Vec3f p(coordinate(random), coordinate(random), coordinate(random));
    if (const float d = boundary.distance(p); d > 0 && d < most) points.push_back(p);
  }
  return points;
}

TEST(GammaProperties, IsAPartAndWholeBeyondTheSupport) {
  for (const Scenery& scenery : sceneries()) {
    for (const std::string_view name : gammaMethodNames()) {
      if (name == "monte_carlo") continue;
      const PickedGamma picked = make(scenery.boundary, name);
      const auto points = fluidPoints(scenery.boundary, 80, 2 * kSupport);
      const auto samples = evaluate(*picked.method, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_GE(samples[i].gamma, 0) << scenery.name << " " << name;
        ASSERT_LE(samples[i].gamma, 1) << scenery.name << " " << name;
        ASSERT_NEAR(samples[i].distance, scenery.boundary.distance(points[i]), 1e-6F) << name;
        if (samples[i].distance < kSupport * 1.0001F) continue;
        ASSERT_EQ(samples[i].gamma, 1) << scenery.name << " " << name;
        ASSERT_EQ(samples[i].gradient.norm(), 0) << scenery.name << " " << name;
      }
    }
  }
}

TEST(GammaProperties, IsContinuousAlongRandomPaths) {
  // Steps of a thousandth of the support radius: the steepest gamma changes by 0.0014 in one, the rest is
  // what a method may jump by where it changes its mind.
  const std::pair<const char*, float> methods[] = {
      {"auto", 0.008F}, {"directions", 0.005F}, {"baked", 0.004F}};
  std::mt19937 random(9);
  for (const Scenery& scenery : sceneries()) {
    const auto ends = fluidPoints(scenery.boundary, 8);
    for (const auto& [name, most] : methods) {
      const PickedGamma picked = make(scenery.boundary, name);
      for (std::size_t path = 0; path + 1 < ends.size(); path += 2) {
        const Vec3f way = ends[path + 1] - ends[path];
        const int steps = static_cast<int>(way.norm() / (1e-3F * kSupport)) + 1;
        std::vector<Vec3f> points;
        for (int k = 0; k <= steps; ++k)
          points.emplace_back(ends[path] + static_cast<float>(k) / static_cast<float>(steps) * way);
        const auto samples = evaluate(*picked.method, points);
        for (std::size_t k = 1; k < samples.size(); ++k) {
          if (samples[k].distance < 0 || samples[k - 1].distance < 0) continue;
          ASSERT_LT(std::abs(samples[k].gamma - samples[k - 1].gamma), most)
              << scenery.name << " " << name << " at " << points[k].transpose();
        }
      }
    }
  }
}

TEST(GammaProperties, BakedGradientsAreTheDerivativesOfBakedGamma) {
  for (const Scenery& scenery : sceneries()) {
    const PickedGamma picked = make(scenery.boundary, "baked");
    const auto points = fluidPoints(scenery.boundary, 60, 0.95F * kSupport);
    const auto samples = evaluate(*picked.method, points);
    constexpr float kStep = 3e-4F;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (samples[i].distance < 2 * kStep) continue;
      Vec3f difference;
      float highest = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3f step = kStep * Vec3f::Unit(axis);
        const auto pair = evaluate(*picked.method, {points[i] + step, points[i] - step});
        difference[axis] = (pair[0].gamma - pair[1].gamma) / (2 * kStep / kSupport);
        highest = std::max({highest, pair[0].gamma, pair[1].gamma});
      }
      if (highest == 1) continue;  // at the end of its range gamma has a kink
      ASSERT_LT((difference - samples[i].gradient).norm(), 0.002F)
          << scenery.name << " " << points[i].transpose();
    }
  }
}

TEST(GammaProperties, TurnsWithTheWalls) {
  const Rotation turn{{0.3, 1, -0.5}, 67};
  const Eigen::Matrix3d matrix = turn.matrix();
  const Eigen::Matrix3f matrixf = matrix.cast<float>();
  const Vec3d first(0, 1, 0), second(0.8, -0.6, 0), third(0.1, 0.2, 1);
  const Boundary corner(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), first),
                                 std::make_shared<Plane>(Vec3d::Zero(), second),
                                 std::make_shared<Plane>(Vec3d::Zero(), third)});
  const Boundary turned(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), matrix * first),
                                 std::make_shared<Plane>(Vec3d::Zero(), matrix * second),
                                 std::make_shared<Plane>(Vec3d::Zero(), matrix * third)});
  const auto points = fluidPoints(corner, 200);
  std::vector<Vec3f> there;
  for (const Vec3f& p : points) there.emplace_back(matrixf * p);
  // Closed forms do not know the axes; fixed directions and grids do, within their errors.
  const std::pair<const char*, float> methods[] = {{"nearest", 2e-6F},     {"mean", 2e-5F},
                                                   {"product", 5e-6F},     {"copula", 2e-5F},
                                                   {"directions", 0.003F}, {"auto", 0.003F}};
  for (const auto& [name, most] : methods) {
    const auto here = evaluate(*make(corner, name).method, points);
    const auto after = evaluate(*make(turned, name).method, there);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(here[i].gamma, after[i].gamma, most) << name;
      ASSERT_LT((matrixf * here[i].gradient - after[i].gradient).norm(), 15 * most) << name;
    }
  }
}

TEST(GammaProperties, WhatDisjointSolidsTakeAwayAdds) {
  const auto floor = std::make_shared<Plane>(Vec3d(0, -0.2, 0), Vec3d::UnitY());
  const auto ball = std::make_shared<Sphere>(Vec3d(0, 0, 0), 0.14, Sphere::Fluid::outside);
  const auto block = std::make_shared<Box>(Vec3d(0.18, -0.1, -0.2), Vec3d(0.4, 0.2, 0.2), Box::Fluid::outside,
                                           Rotation{{0, 0, 1}, 10});
  const Boundary together(Surfaces{floor, ball, block});
  const auto points = fluidPoints(together, 300);
  for (const auto& [name, most] :
       {std::pair("directions", 0.004F), std::pair("auto", 0.006F), std::pair("baked", 0.004F)}) {
    const auto joint = evaluate(*make(together, name).method, points);
    std::vector<float> taken(points.size(), 0);
    int both = 0;
    std::vector<int> near(points.size(), 0);
    for (const std::shared_ptr<const Surface>& surface : Surfaces{floor, ball, block}) {
      const Boundary alone(Surfaces{surface});
      const auto single = evaluate(*make(alone, name).method, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        taken[i] += 1 - single[i].gamma;
        if (single[i].gamma < 0.95F) ++near[i];
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      both += near[i] > 1 ? 1 : 0;
      ASSERT_NEAR(joint[i].gamma, 1 - taken[i], most) << name << " at " << points[i].transpose();
    }
    EXPECT_GT(both, 10) << "places between two solids";
  }
}

TEST(GammaProperties, EveryInstructionSetAgrees) {
  for (const Scenery& scenery : sceneries()) {
    for (const KernelType kernel : kKernels) {
      for (const std::string_view name : {"product", "directions", "baked"}) {
        if (name == "baked" && kernel != KernelType::poly6) continue;  // splines are the same for all
        const PickedGamma picked = make(scenery.boundary, name, kernel);
        const auto points = fluidPoints(scenery.boundary, 37);
        const auto best = evaluate(*picked.method, points);
        for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
          hwy::SetSupportedTargetsForTest(targets & -targets);
          const auto other = evaluate(*picked.method, points);
          hwy::SetSupportedTargetsForTest(0);
          for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_NEAR(best[i].gamma, other[i].gamma, 2e-6F) << name;
            ASSERT_LT((best[i].gradient - other[i].gradient).norm(), 2e-5F) << name;
            ASSERT_LT((best[i].pairGradient - other[i].pairGradient).norm(), 2e-5F) << name;
          }
        }
      }
    }
  }
}

}  // namespace gamma_properties_test
}  // namespace migiwa
