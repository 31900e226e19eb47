// Gauges against closed forms: water at rest whose level and pressure are known.
#include "core/simulation/gauges.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/io/report.h"
#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace gauges_test {

using namespace migiwa::testing;

constexpr double kPerMetre = 1000 * 9.81;  // rho0 g (Pa/m)
constexpr double kLevel = 12 * kSpacing;

Gauge gaugeAt(GaugeKind kind, const Vec3d& at) {
  Gauge gauge;
  gauge.kind = kind;
  gauge.at = at;
  gauge.name = "gauge";
  return gauge;
}

Gauge gaugeAlong(GaugeKind kind, const Vec3d& direction) {
  Gauge gauge = gaugeAt(kind, Vec3d::Zero());
  gauge.direction = direction;
  return gauge;
}

/// A tank of 10 x 12 x 10 particles on their lattice, with the pressures of water at rest.
class Tank {
 public:
  Tank() : scene_(stillTank({10, 12, 10})), boundary_(scene_.surfaces) {
    std::vector<Vec3d> centers;
    scene_.fluid.front()->fill(kSpacing, centers);
    for (const Vec3d& center : centers) {
      positions_.emplace_back(Vec3f(center.cast<float>()));
      velocities_.emplace_back(Vec3f(0.3F, 0, 0.4F));
      pressures_.push_back(static_cast<float>(kPerMetre * (kLevel - center.y())));
    }
    gamma_ = makeHandling(BoundaryHandling::gamma, 0,
                          {boundary_, scene_.solver.kernel, static_cast<float>(scene_.supportRadius())})
                 .method;
  }

  std::optional<double> read(const Gauge& gauge) {
    scene_.gauges = {gauge};
    return GaugeReader(scene_, boundary_)
        .read(0, {positions_, velocities_, pressures_}, gamma_.get(), scene_.solver.kernel,
              scene_.supportRadius());
  }

 private:
  Scene scene_;
  Boundary boundary_;
  std::vector<Float4> positions_, velocities_;
  std::vector<float> pressures_;
  std::unique_ptr<GammaMethod> gamma_;
};

TEST(Gauges, HeightOfALevelSurfaceIsItsLevelAlsoAtWallsAndInCorners) {
  Tank tank;
  const double middle = 0.25;
  for (const Vec3d& at :
       {Vec3d(middle, 0, middle), Vec3d(0.01, 0, middle), Vec3d(0.01, 0, 0.01), Vec3d(0.49, 0, 0.3)})
    EXPECT_NEAR(*tank.read(gaugeAt(GaugeKind::height, at)), kLevel, 0.05 * kSpacing) << at.transpose();
  // Counted from where the line begins.
  EXPECT_NEAR(*tank.read(gaugeAt(GaugeKind::height, {middle, 0.2, middle})), kLevel - 0.2, 0.05 * kSpacing);
  EXPECT_EQ(*tank.read(gaugeAt(GaugeKind::height, {middle, 0.8, middle})), 0);
}

TEST(Gauges, PressureOfWaterAtRestIsThatOfItsDepthAlsoOnTheFloorAndInCorners) {
  Tank tank;
  for (const Vec3d& at :
       {Vec3d(0.25, 0.25, 0.25), Vec3d(0.25, 0, 0.25), Vec3d(0, 0, 0), Vec3d(0.5, 0.1, 0.2)})
    EXPECT_NEAR(*tank.read(gaugeAt(GaugeKind::pressure, at)), kPerMetre * (kLevel - at.y()), 0.5)
        << at.transpose();
  EXPECT_EQ(*tank.read(gaugeAt(GaugeKind::pressure, {0.25, 1, 0.25})), 0);
  // A larger ball looks farther.
  Gauge far = gaugeAt(GaugeKind::pressure, {0.25, 0.7, 0.25});
  EXPECT_EQ(*tank.read(far), 0);
  far.at.y() = kLevel;
  far.radius = 0.3;
  EXPECT_NEAR(*tank.read(far), 0, 0.5);
}

TEST(Gauges, CentreFrontAndSpeedAreThoseOfTheBlock) {
  Tank tank;
  EXPECT_NEAR(*tank.read(gaugeAlong(GaugeKind::centre, {0, 2, 0})), 0.5 * kLevel, 1e-6);
  EXPECT_NEAR(*tank.read(gaugeAlong(GaugeKind::front, {1, 0, 0})), 0.5, 1e-6);
  EXPECT_NEAR(*tank.read(gaugeAlong(GaugeKind::front, {-1, 0, 0})), 0, 1e-6);
  EXPECT_NEAR(*tank.read(gaugeAlong(GaugeKind::speed, Vec3d::Zero())), 0.5, 1e-6);
}

TEST(Gauges, OneOnAWallGoesAlongWithIt) {
  Scene scene = stillTank({10, 12, 10});
  auto plate = std::make_shared<Box>(Vec3d(2, 0, 0), Vec3d(3, 1, 1), Box::Fluid::outside, Rotation{});
  plate->motion.emplace();
  plate->motion->velocity = {-1, 0, 0};
  scene.surfaces.push_back(plate);
  Gauge gauge = gaugeAt(GaugeKind::height, {2.25, 0, 0.25});
  gauge.wall = 1;
  scene.gauges = {gauge};
  Boundary boundary(scene.surfaces);
  const std::vector<Float4> column{Float4(0.25F, 0.02F, 0.25F), Float4(0.25F, 0.04F, 0.25F),
                                   Float4(0.25F, 0.06F, 0.25F), Float4(0.25F, 0.08F, 0.25F),
                                   Float4(0.25F, 0.05F, 0.26F), Float4(0.26F, 0.05F, 0.25F)};
  const GaugeReader reader(scene, boundary);
  const auto height = [&](double time) {
    boundary.moveTo(time, time);
    return *reader.read(0, {column, column, {}}, nullptr, scene.solver.kernel, scene.supportRadius());
  };
  EXPECT_EQ(height(0), 0);
  EXPECT_GT(height(2), 0.05);
  EXPECT_EQ(height(4), 0);
}

Scene gaugedTank() {
  Scene scene = stillTank({8, 16, 8});
  scene.gauges = {gaugeAt(GaugeKind::pressure, {0.2, 0, 0.2}), gaugeAt(GaugeKind::height, {0.2, 0, 0.2}),
                  gaugeAlong(GaugeKind::centre, {0, 1, 0})};
  scene.gauges[1].name = "height";
  scene.gauges[2].name = "centre";
  return scene;
}

TEST(Gauges, OnTheFloorOfARestingTankShowRhoGDepth) {
  Simulation simulation(gaugedTank(), 1);
  while (simulation.time() < 2) simulation.advanceFrame();
  const std::vector<GaugeSeries>& series = simulation.statistics().gauges;
  ASSERT_EQ(series.size(), 3u);
  double pressure = 0, height = 0;
  for (std::size_t k = 1; k <= 100; ++k) {
    pressure += (series[0].history.end() - static_cast<std::ptrdiff_t>(k))->value / 100;
    height += (series[1].history.end() - static_cast<std::ptrdiff_t>(k))->value / 100;
  }
  EXPECT_NEAR(pressure, kPerMetre * 0.8, 0.06 * kPerMetre * 0.8);
  // The tolerance of the solver is a hundredth.
  EXPECT_NEAR(height, 0.8, 0.015);
}

// The column stands on the floor, however many substeps a frame has.
TEST(Gauges, PressureIsTheMeanOverTheSubstepsOfAFrame) {
  Scene scene = gaugedTank();
  scene.solver.timeStep = 0.02;
  scene.solver.substeps = 4;
  Simulation simulation(scene, 1);
  while (simulation.time() < 2) simulation.advanceFrame();
  const std::vector<GaugeSample>& shown = simulation.statistics().gauges[0].history;
  ASSERT_EQ(shown.size(), 100u);
  double mean = 0, squares = 0;
  for (auto sample = shown.end() - 25; sample != shown.end(); ++sample) {
    mean += sample->value / 25;
    squares += sample->value * sample->value / 25;
  }
  EXPECT_NEAR(mean, kPerMetre * 0.8, 0.06 * kPerMetre * 0.8);
  // Single substeps scatter by a quarter and more.
  EXPECT_LT(std::sqrt(std::max(squares - mean * mean, 0.0)), 0.1 * mean);
}

TEST(Gauges, ChangeNothingAndAreKeptInASave) {
  Scene plain = gaugedTank();
  plain.gauges.clear();
  Simulation gauged(gaugedTank(), 2), alone(plain, 1);
  for (int frame = 0; frame < 20; ++frame) gauged.advanceFrame(), alone.advanceFrame();
  EXPECT_EQ(gauged.stateHash(), alone.stateHash());

  const StateImage image = StateImage::of(gauged);
  Simulation resumed(gaugedTank(), 1);
  image.restore(resumed);
  for (int frame = 0; frame < 20; ++frame) gauged.advanceFrame(), resumed.advanceFrame();
  const Report report = makeReport(gauged, {}, {}), other = makeReport(resumed, {}, {});
  ASSERT_EQ(report.gauges.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(report.gauges[k].times, other.gauges[k].times);
    EXPECT_EQ(report.gauges[k].values, other.gauges[k].values);
  }
  // The start and every frame; there is no pressure before the first step.
  EXPECT_EQ(report.gauges[0].times.size(), 40u);
  EXPECT_EQ(report.gauges[1].times.size(), 41u);
  EXPECT_TRUE(gaugesCsv(report).starts_with("time (s),gauge (Pa),height (m),centre (m)\n0,,"));
}

TEST(StartMotion, SpinAndWavesAddToTheVelocity) {
  BoxSource source(Vec3d::Zero(), Vec3d::Ones());
  source.velocity = {0, 0, 0.5};
  source.spin = {true, {0, 2, 0}, {1, 0, 0}, 180};
  source.velocityWaves = {{{0, 0.25, 0}, {std::numbers::pi, 0, 0}, {0.5, 0, 0}}};
  // About y through (1, 0, 0), half a turn a second: v = pi (z, 0, -(x - 1)).
  const Vec3d v = source.velocityAt({0.5, 0.3, 0.2});
  EXPECT_NEAR(v.x(), 0.2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(v.y(), 0.25, 1e-12);
  EXPECT_NEAR(v.z(), 0.5 + 0.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(source.velocityAt({1, 0, 0}).y(), 0, 1e-12);
  EXPECT_GE(source.largestSpeed(), source.velocityAt({0, 0, 1}).norm());
}

}  // namespace gauges_test
}  // namespace migiwa
