// Paths of light against conservation of energy and closed forms; the medium of every stretch against the
// shape that the water has.
#include "app/raytrace/paths.h"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/scene_surface.h"
#include "core/simulation/simulation.h"
#include "core/slim/points.h"
#include "tests/raytrace/stages.h"

namespace migiwa {
namespace paths_test {

using WavyTank = testing::WavyTank;

constexpr int kNoEnd = 4000;

/// A direction spread evenly over the sphere.
Vec3f anyDirection(RandomSequence& random) {
  const double z = 2 * random.unit() - 1, turn = 2 * std::numbers::pi * random.unit();
  const double r = std::sqrt(1 - z * z);
  return Vec3d(r * std::cos(turn), z, r * std::sin(turn)).cast<float>();
}

/// Rays from around the tank towards places in it.
struct Aim {
  Vec3f eye, direction;
};
Aim anyAim(RandomSequence& random) {
  const Vec3f target(static_cast<float>(random.unit() * WavyTank::kWidth),
                     static_cast<float>(random.unit() * 0.6),
                     static_cast<float>(random.unit() * WavyTank::kDepth));
  const Vec3f way = anyDirection(random);
  return {target - 3 * way, way};
}

/// Mean radiance of `count` paths, and its standard error.
std::pair<double, double> meanRadiance(const Stage& stage, int count, const std::function<Aim(int)>& aim,
                                       PathCounts& counts) {
  double sum = 0, squares = 0;
  for (int k = 0; k < count; ++k) {
    PixelSamples random(3, static_cast<std::uint32_t>(k), 0, 1);
    const Aim at = aim(k);
    const PathSample sample =
        tracePath(stage, at.eye, at.direction, stage.placeOf(at.eye), random, counts, kNoEnd);
    const auto mean = static_cast<double>(sample.radiance.mean());
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

TEST(Paths, InAFurnaceNothingIsSeen) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  WavyTank tank;
  tank.scene.surfaces.push_back(std::make_shared<Sphere>(Vec3d(0.6, 0.6, 0.3), 0.12, Sphere::Fluid::outside));
  tank.scene.surfaces.push_back(
      std::make_shared<Box>(Vec3d(0.1, 0.5, 0.1), Vec3d(0.25, 0.7, 0.3), Box::Fluid::outside));
  tank.scene.view.look.walls = {WallMaterial::glass, WallMaterial::glass, WallMaterial::matt};
  tank.walls = Boundary(tank.scene.surfaces);
  const Stage stage(tank.content());
  RandomSequence random(1);
  PathCounts counts;
  const auto [mean, error] = meanRadiance(
      stage, 40000, [&](int) { return anyAim(random); }, counts);
  EXPECT_NEAR(mean, 1, 0.002);
  EXPECT_LT(error, 0.001);
  EXPECT_EQ(counts.leaked, 0U);
}

TEST(Paths, AGlassBallKeepsAllLight) {
  WavyTank tank;
  tank.scene.surfaces = {std::make_shared<Sphere>(Vec3d(0.5, 1.5, 0.3), 0.3, Sphere::Fluid::outside)};
  tank.scene.view.look.walls = {WallMaterial::glass};
  tank.walls = Boundary(tank.scene.surfaces);
  tank.water = {};
  const Stage stage(tank.content());
  RandomSequence random(2);
  PathCounts counts;
  const auto aim = [&](int) {
    const Vec3f way = anyDirection(random), across = way.unitOrthogonal();
    return Aim{Vec3f(0.5F, 1.5F, 0.3F) + static_cast<float>(0.3 * random.unit()) * across - 2 * way, way};
  };
  const auto [mean, error] = meanRadiance(stage, 20000, aim, counts);
  EXPECT_NEAR(mean, 1, 1e-5);
  EXPECT_EQ(counts.contradictions, 0U);
}

TEST(Paths, ASlabOfWaterTakesAsBeerAndLambertSay) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  // Head on, with what goes to and fro between its faces: T = (1 - R)^2 A / (1 - R^2 A^2), and what comes
  // back is R + R (1 - R)^2 A^2 / (1 - R^2 A^2).
  WavyTank tank(10, 0);
  tank.scene.surfaces.clear();
  tank.walls = Boundary(tank.scene.surfaces);
  std::fill(tank.water.wet.begin(), tank.water.wet.end(), std::uint8_t{0});
  tank.scene.view.look.waterColor = {0.25, 0.5, 1};
  tank.scene.view.look.waterDepth = 0.7;
  const Stage stage(tank.content());
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(stage.transmittance(Medium::water, 0.35F)[channel],
                std::pow(tank.scene.view.look.waterColor[channel], 0.5), 1e-6);
  const double reflectance = std::pow(0.333 / 2.333, 2);
  PathCounts counts;
  Vec3d sum = Vec3d::Zero();
  constexpr int kCount = 100000;
  for (int k = 0; k < kCount; ++k) {
    PixelSamples random(5, static_cast<std::uint32_t>(k), 0, 1);
    sum += tracePath(stage, {0.43F, 2, 0.31F}, -Vec3f::UnitY(), {}, random, counts, kNoEnd)
               .radiance.cast<double>();
  }
  for (int channel = 0; channel < 3; ++channel) {
    const double a = std::pow(tank.scene.view.look.waterColor[channel], 0.5), r = reflectance;
    const double through = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
    const double back = r + r * (1 - r) * (1 - r) * a * a / (1 - r * r * a * a);
    // Of light that is there wholly or in part, a sample scatters by less than a quarter.
    EXPECT_NEAR(sum[channel] / kCount, through + back, 4 * 0.25 / std::sqrt(kCount)) << channel;
  }
}

/// Whether each end of a stretch has the medium that the shape of the water puts there.
TEST(Paths, LabelsAgreeWithTheShape) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const WavyTank tank(160);
  const Stage stage(tank.content());
  RandomSequence random(4);
  int checked = 0;
  constexpr float kNear = 2e-3F;
  const auto inTank = [](const Vec3f& p) {
    return p.minCoeff() > 0 && p.x() < 1 && p.y() < 0.8F && p.z() < 0.6F;
  };
  for (int k = 0; k < 20000; ++k) {
    const Vec3f origin(static_cast<float>(random.unit()), static_cast<float>(0.8 * random.unit()),
                       static_cast<float>(0.6 * random.unit()));
    const Vec3f direction = anyDirection(random);
    const Place place{tank.mediumAt(origin)};
    if (tank.mediumAt(origin + Vec3f(0, kNear, 0)) != tank.mediumAt(origin - Vec3f(0, kNear, 0))) continue;
    const Event event = stage.next(origin, direction, place);
    if (event.kind != Event::Kind::interface) continue;
    const Vec3f before = event.point + kNear * event.normal, beyond = event.point - kNear * event.normal;
    if (inTank(before) &&
        tank.mediumAt(before + Vec3f(0, kNear, 0)) == tank.mediumAt(before - Vec3f(0, kNear, 0))) {
      ASSERT_EQ(event.before, tank.mediumAt(before)) << k;
      ++checked;
    }
    if (inTank(beyond)) {
      ASSERT_EQ(event.beyond.medium, tank.mediumAt(beyond)) << k;
      ++checked;
    }
  }
  EXPECT_GT(checked, 20000);
}

void expectNoLeak(int count) {
  const WavyTank tank(80);
  // The ground is as near to the water as the tank's glass is thick, and yet dry.
  const Stage stage(tank.content(Surround::studio, true));
  RandomSequence random(5);
  PathCounts counts;
  for (int k = 0; k < count; ++k) {
    const Aim at = anyAim(random);
    PixelSamples samples(6, static_cast<std::uint32_t>(k), 0, 1);
    tracePath(stage, at.eye, at.direction, stage.placeOf(at.eye), samples, counts);
  }
  EXPECT_EQ(counts.leaked, 0U);
  EXPECT_LT(static_cast<double>(counts.contradictions), 1e-4 * static_cast<double>(counts.stretches));
  ::testing::Test::RecordProperty("contradictions", static_cast<int>(counts.contradictions));
  ::testing::Test::RecordProperty("stretches", std::to_string(counts.stretches));
}

TEST(Paths, NoneLeaks) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  expectNoLeak(100000);
}
TEST(Paths, NoneOfMillionsLeaks) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  expectNoLeak(10000000);
}

/// Paths to where water, air and glass meet, off by a few times as much as rays start off a surface: rounding
/// decides there what a ray comes to first. Of paths to anywhere one of 10^7 comes there.
TEST(Paths, NoneLeaksAtTheContactLine) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const WavyTank tank(80);
  const Stage stage(tank.content(Surround::studio, true));
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> wetEdges;
  const auto each = [&](const std::function<void(std::size_t, std::uint32_t, std::uint32_t)>& visit) {
    for (std::size_t k = 0; k < tank.water.triangles.size(); ++k)
      for (std::size_t side = 0; side < 3; ++side)
        visit(k, tank.water.triangles[k][side], tank.water.triangles[k][(side + 1) % 3]);
  };
  each([&](std::size_t k, std::uint32_t a, std::uint32_t b) {
    if (tank.water.wet[k] != 0) wetEdges[{b, a}] = true;
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> line;
  each([&](std::size_t k, std::uint32_t a, std::uint32_t b) {
    if (tank.water.wet[k] == 0 && wetEdges.contains({a, b})) line.emplace_back(a, b);
  });
  ASSERT_EQ(line.size(), 2U * (80 + 48));
  RandomSequence random(9);
  PathCounts counts;
  for (int k = 0; k < 200000; ++k) {
    const auto [a, b] = line[static_cast<std::size_t>(random.unit() * static_cast<double>(line.size()))];
    const Vec3f &p = tank.water.positions[a], &q = tank.water.positions[b];
    const Vec3f aside = static_cast<float>(4 * random.unit()) * stage.offset() * anyDirection(random);
    const Vec3f target = p + static_cast<float>(random.unit()) * (q - p) + aside, way = anyDirection(random);
    PixelSamples samples(10, static_cast<std::uint32_t>(k), 0, 1);
    const Vec3f eye = target - 3 * way;
    tracePath(stage, eye, way, stage.placeOf(eye), samples, counts);
  }
  EXPECT_EQ(counts.leaked, 0U) << counts.contradictions << " contradictions in " << counts.stretches;
}

/// Water that lies in the bowl of scenes/bowl.json, whose drawn triangles are off the wall that the water's
/// mesh ends at.
TEST(Paths, NoneLeaksAtAWallThatIsDrawnByTriangles) {
  const Scene scene = readScene(
      std::filesystem::path(MIGIWA_SOURCE_DIR) / "scenes" / "bowl.json",
      {Override::parse(R"(/fluid=[{"shape":"sphere","center":[0,-0.8,0],"radius":0.64}])"),
       Override::parse("/boundary/handling=none")});  // gamma's grid would take longer than the paths
  const Simulation simulation(scene);
  ThreadPool pool(2);
  SceneSurface surface(simulation.scene(), SurfaceOptions{}, pool);
  const SurfaceMesh water = surface.mesh(simulation.view().positions, {}, 0);
  const Stage stage({.scene = &simulation.scene(), .walls = &surface.boundary(), .water = &water});
  RandomSequence random(7);
  PathCounts counts;
  for (int k = 0; k < 300000; ++k) {
    const Vec3f way = anyDirection(random);
    const Vec3f target =
        static_cast<float>(0.9 * random.unit()) * anyDirection(random) - 0.6F * Vec3f::UnitY();
    PixelSamples samples(8, static_cast<std::uint32_t>(k), 0, 1);
    const Vec3f eye = target - 5 * way;
    tracePath(stage, eye, way, stage.placeOf(eye), samples, counts);
  }
  EXPECT_EQ(counts.leaked, 0U) << counts.contradictions << " contradictions in " << counts.stretches;
}

}  // namespace paths_test
}  // namespace migiwa
