// Sources that touch and overlap: no place is taken twice, none is filled beyond its box, and no gap is left.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/scene/sources.h"
#include "core/simulation/fill.h"

namespace migiwa {
namespace source_union_test {

using Sources = std::vector<std::shared_ptr<const FluidSource>>;

struct Filling {
  Particles particles;
  std::vector<std::string> warnings;
};

Filling filled(Sources sources, double spacing) {
  Scene scene;
  scene.particleSpacing = spacing;
  scene.fluid = std::move(sources);
  Filling result;
  fillScene(scene, Boundary(scene.surfaces), result.particles);
  result.warnings = scene.warnings;
  return result;
}

std::shared_ptr<const FluidSource> box(const Vec3d& min, const Vec3d& max) {
  return std::make_shared<BoxSource>(min, max);
}

double nearest(const Particles& particles) {
  double least = INFINITY;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      least = std::min<double>(
          least, (particles.position[i].xyz() - particles.position[k].xyz()).cast<double>().norm());
  return least;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + "\n";
  return all;
}

TEST(SourceUnion, LayersThatTouchAreOneLattice) {
  // However high the layers are, along any axis and in any order, they hold what one box of both holds.
  for (int axis = 0; axis < 3; ++axis)
    for (const double low : {0.33, 0.3, 0.26, 0.241, 0.299})
      for (const double high : {0.33, 0.25, 0.074}) {
        Vec3d a = Vec3d::Constant(0.2), from = Vec3d::Zero(), b = a;
        a[axis] = low, from[axis] = low, b[axis] = low + high;
        const auto lower = box(Vec3d::Zero(), a), upper = box(from, b), whole = box(Vec3d::Zero(), b);
        const std::size_t expected = filled({whole}, 0.05).particles.size();
        for (const Sources& sources : {Sources{lower, upper}, Sources{upper, lower}}) {
          const Filling both = filled(sources, 0.05);
          EXPECT_EQ(both.particles.size(), expected) << axis << ' ' << low << ' ' << high;
          EXPECT_NEAR(nearest(both.particles), 0.05, 1e-6);
        }
      }
}

TEST(SourceUnion, ThinLayersAddUp) {
  Sources layers;
  for (int k = 0; k < 10; ++k) layers.push_back(box({0, 0.04 * k, 0}, {0.1, 0.04 * (k + 1), 0.1}));
  EXPECT_EQ(filled(layers, 0.05).particles.size(), 2U * 8U * 2U);
}

TEST(SourceUnion, NothingStandsOutBelowABoxThatIsWiderThanTheOneBeneath) {
  // Only above the lower box does the upper one begin before its min.
  const Filling both = filled({box({0, 0, 0}, {0.2, 0.33, 0.2}), box({0, 0.33, 0}, {0.5, 0.66, 0.2})}, 0.05);
  EXPECT_EQ(both.particles.size(), 4U * 13U * 4U + 6U * 6U * 4U);
  for (const Float4& p : both.particles.position)
    if (p.x > 0.2F) {
      EXPECT_GT(p.y, 0.33F + 0.02F);
    }
}

TEST(SourceUnion, AnOverlapIsFilledOnceAndSaid) {
  const Filling both = filled({box({0, 0, 0}, {2, 0.5, 0.5}), box({0, 0.25, 0}, {2, 0.75, 0.5})}, 0.05);
  EXPECT_EQ(both.particles.size(), 6000U);
  ASSERT_EQ(both.warnings.size(), 1U);
  EXPECT_EQ(both.warnings[0],
            "/fluid/1: 50 % of its particles (2000 of 4000) lie where those of earlier sources are already "
            "and are left out");
}

TEST(SourceUnion, WhatDoesNotFitIsSaidWithItsShare) {
  const Filling one = filled({box({0, 0, 0}, {0.2, 0.33, 0.2})}, 0.05);
  ASSERT_EQ(one.warnings.size(), 1U);
  EXPECT_NE(one.warnings[0].find("/fluid/0: 9.09 % of its volume stay empty: 0.03 m along y before max"),
            std::string::npos)
      << one.warnings[0];
  const Filling two = filled({box({0, 0, 0}, {0.2, 0.33, 0.2}), box({0, 0.33, 0}, {0.2, 0.66, 0.2})}, 0.05);
  ASSERT_EQ(two.warnings.size(), 2U);
  EXPECT_NE(two.warnings[1].find("/fluid/1: 6.06 % of its volume are added: it begins 0.03 m along y before "
                                 "min, to go on from the box that it touches, and ends 0.01 m along y"),
            std::string::npos)
      << two.warnings[1];
  EXPECT_TRUE(filled({box({0, 0, 0}, {0.2, 0.3, 0.2})}, 0.05).warnings.empty());
  const Filling none = filled({box({0, 0, 0}, {0.2, 0.04, 0.2})}, 0.05);
  EXPECT_NE(joined(none.warnings).find("thinner than particle_spacing"), std::string::npos);
}

TEST(SourceUnion, NoTwoSourcesComeNearerThanNineTenths) {
  // Boxes, turned boxes and balls at random: every pair of particles is compared.
  RandomSequence random(7);
  for (int round = 0; round < 40; ++round) {
    Sources sources;
    double most = 0;
    for (int k = 0; k < 4; ++k) {
      const auto place = [&] { return Vec3d(random.unit(), random.unit(), random.unit()); };
      const Vec3d at = 0.5 * place(), size = Vec3d::Constant(0.15) + 0.3 * place();
      const Rotation turn{.axis = place() + Vec3d(0.1, 0, 0), .degrees = k == 1 ? 90 * random.unit() : 0};
      if (k < 3)
        sources.push_back(std::make_shared<BoxSource>(at, Vec3d(at + size), turn));
      else
        sources.push_back(std::make_shared<SphereSource>(at, 0.2));
      most += sources.back()->count(0.05);
    }
    const Filling all = filled(sources, 0.05);
    EXPECT_GE(nearest(all.particles), 0.9 * 0.05 - 1e-6) << round;
    EXPECT_LE(static_cast<double>(all.particles.size()), most);
    // Each place of a box whose cell is in it has a particle near it.
    for (std::size_t k = 0; k < sources.size(); ++k) {
      std::vector<Vec3d> own;
      sources[k]->fill(0.05, own);
      for (std::size_t p = 0; p < own.size(); p += 37) {
        double least = INFINITY;
        for (const Float4& q : all.particles.position)
          least = std::min(least, (q.xyz().cast<double>() - own[p]).norm());
        EXPECT_LT(least, 0.09) << round << ' ' << k;
      }
    }
  }
}

TEST(SourceUnion, WithoutTrimWhatOverlapsStays) {
  const Scene read = parseScene(R"({ "format": 1, "particle_spacing": 0.05, "fluid": [
      { "shape": "box", "min": [0, 0, 0], "max": [0.1, 0.1, 0.1] },
      { "shape": "box", "min": [0, 0, 0], "max": [0.1, 0.1, 0.1], "trim": false }] })",
                                "kept.json");
  Scene scene = read;
  Particles particles;
  fillScene(scene, Boundary(scene.surfaces), particles);
  EXPECT_EQ(particles.size(), 16U);
}

TEST(SourceUnion, WhatLiesOutsideOfTheWallsIsSaidWithItsShare) {
  Scene scene = parseScene(R"({ "format": 1, "particle_spacing": 0.05, "fluid": [
      { "shape": "box", "min": [-1, 0, 0], "max": [1, 0.5, 1] }],
      "boundary": { "surfaces": [
        { "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 1] }] } })",
                           "half.json");
  Particles particles;
  fillScene(scene, Boundary(scene.surfaces), particles);
  EXPECT_EQ(particles.size(), 4000U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(
      scene.warnings[0],
      "/fluid/0: 50 % of its particles (4000 of 8000) lie within or too near the walls and are left out");
}

}  // namespace source_union_test
}  // namespace migiwa
