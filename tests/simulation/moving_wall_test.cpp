// Walls that move take the fluid along, and only as a wall may.
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/walls/shapes.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace moving_wall_test {

using namespace migiwa::testing;

Motion atVelocity(const Vec3d& velocity, double stop = 1e6) {
  Motion motion;
  motion.velocity = velocity;
  motion.stop = stop;
  return motion;
}

std::shared_ptr<Box> block(const Vec3d& min, const Vec3d& max, const Motion& motion) {
  auto box = std::make_shared<Box>(min, max, Box::Fluid::outside, Rotation{});
  box->motion = motion;
  return box;
}

Vec3d centreOfMass(const FrameView& view) {
  Vec3d sum = Vec3d::Zero();
  for (const Float4& p : view.positions) sum += p.xyz().cast<double>();
  return sum / static_cast<double>(view.positions.size());
}

constexpr double kLength = 1.2, kWidth = 0.3, kDepth = 0.3;

/// A tank at rest in which a piston, a block as wide as the tank, pushes the water together from x = 0.
Scene pistonTank(double speed, double stop) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {kLength, kDepth, kWidth});
  addTank(scene, Vec3d::Zero(), {kLength, 1, kWidth});
  scene.surfaces.push_back(
      block({-0.8, -0.2, -0.2}, {0, 1.2, kWidth + 0.2}, atVelocity({speed, 0, 0}, stop)));
  addViscosity(scene);
  return scene;
}

TEST(Piston, RaisesTheLevelByWhatItDisplacesAndDoesTheWorkOfThePressure) {
  // Slow: water 0.3 m deep has waves of 1.7 m/s.
  constexpr double kSpeed = 0.2, kStop = 2;
  Simulation simulation(pistonTank(kSpeed, kStop), 2);
  const auto mass = 1000 * std::pow(kSpacing, 3) * static_cast<double>(simulation.view().positions.size());
  const auto level = [&] { return 2 * centreOfMass(simulation.view()).y(); };
  const auto energy = [&] { return 9.81 * mass * centreOfMass(simulation.view()).y(); };
  for (int k = 0; k < 60; ++k) simulation.advanceFrame();  // not yet: the lattice settles
  const double settledLength = kLength - kSpeed * simulation.time();
  const double before = level(), energyBefore = energy();
  double work = 0;
  while (simulation.time() < kStop) {
    simulation.advanceFrame();
    // p = rho g (level - y) on a face as wide as the tank.
    const double force = 0.5 * 1000 * 9.81 * level() * level() * kWidth;
    work += force * kSpeed * 0.005;
  }
  for (int k = 0; k < 100; ++k) simulation.advanceFrame();
  EXPECT_FALSE(simulation.statistics().failed());
  EXPECT_EQ(simulation.statistics().maxPenetration, 0);
  const double length = kLength - kSpeed * kStop;
  EXPECT_NEAR(level() / before, settledLength / length, 0.02 * settledLength / length);
  EXPECT_NEAR(energy() - energyBefore, work, 0.05 * work);
  // By hydrostatics alone: rho g V^2 / 2 w (1/l1 - 1/l0).
  const double volume = mass / 1000;
  const double closedForm = 0.5 * 1000 * 9.81 * volume * volume / kWidth * (1 / length - 1 / settledLength);
  EXPECT_NEAR(energy() - energyBefore, closedForm, 0.05 * closedForm);
}

TEST(Piston, WaterKeepsUpWithAPlaneThatDrawsBack) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.8, 0.3, 0.3});
  addTank(scene, {-0.4, 0, 0}, {0.8, 0.8, 0.3});
  auto plane = std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(1, 0, 0));
  plane->motion = atVelocity({-0.15, 0, 0}, 2);
  scene.surfaces.push_back(plane);
  addViscosity(scene);
  Simulation simulation(scene, 2);
  for (int k = 0; k < 60; ++k) simulation.advanceFrame();
  const double before = 2 * centreOfMass(simulation.view()).y(), length = 0.8 + 0.15 * simulation.time();
  for (int k = 0; k < 440; ++k) simulation.advanceFrame();
  EXPECT_NEAR(2 * centreOfMass(simulation.view()).y() / before, length / 1.1, 0.02);
  float least = 1;
  for (const Float4& p : simulation.view().positions) least = std::min(least, p.x);
  EXPECT_NEAR(least, -0.3 + 0.5 * kSpacing, 0.5 * kSpacing) << "the water follows the plane";
}

/// Angular momentum about the vertical axis through `centre` over the mass (m^2/s).
double angularMomentum(const FrameView& view, const Vec3d& centre) {
  double sum = 0;
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    const Vec3d r = view.positions[i].xyz().cast<double>() - centre;
    sum += r.cross(Vec3d(view.velocities[i].xyz().cast<double>())).y();
  }
  return sum / static_cast<double>(view.positions.size());
}

double stirred(double degreesPerSecond) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.35, 0.3, 0.85});
  addFluid(scene, {0.5, 0, 0}, {0.85, 0.3, 0.85});
  addTank(scene, Vec3d::Zero(), {0.85, 0.8, 0.85});
  Motion motion;
  motion.turns = true;
  motion.point = {0.425, 0, 0.425};
  motion.degreesPerSecond = degreesPerSecond;
  scene.surfaces.push_back(block({0.35, -0.1, 0.15}, {0.5, 0.9, 0.7}, motion));
  addViscosity(scene);
  Simulation simulation(scene, 2);
  for (int k = 0; k < 100; ++k) simulation.advanceFrame();
  EXPECT_FALSE(simulation.statistics().failed());
  return angularMomentum(simulation.view(), motion.point);
}

TEST(Stirrer, LendsTheWaterItsSenseOfTurn) {
  const double left = stirred(120), right = stirred(-120), still = stirred(1e-9);
  // As one with the plate the water of the tank would have w a^2 / 6.
  const double rigid = 120 * std::numbers::pi / 180 * 0.85 * 0.85 / 6;
  EXPECT_GT(left, 0.1 * rigid);
  EXPECT_LT(left, rigid);
  EXPECT_NEAR(right, -left, 0.1 * left);
  EXPECT_NEAR(still, 0, 0.01 * left);
}

TEST(MovingTank, IsAsOneAtRestWhoseWaterRestsInIt) {
  const Vec3d velocity(0.8, 0.3, -0.5);
  std::vector<Vec3f> places[2];
  for (const bool moves : {false, true}) {
    Scene scene = emptyScene();
    scene.gravity = {0, -9.81, 0};
    addFluid(scene, Vec3d::Zero(), {0.3, 0.4, 0.3}, moves ? velocity : Vec3d(Vec3d::Zero()));
    auto tank = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(0.6, 0.6, 0.3), Box::Fluid::inside, Rotation{});
    if (moves) tank->motion = atVelocity(velocity);
    scene.surfaces.push_back(tank);
    addViscosity(scene);
    scene.solver.minIterations = scene.solver.maxIterations = 4, scene.solver.tolerance = 0;
    scene.solver.cfl = 0;
    scene.solver.substeps = 2;
    Simulation simulation(scene, 2);
    for (int k = 0; k < 40; ++k) simulation.advanceFrame();
    const Vec3f shift = moves ? Vec3f((simulation.time() * velocity).cast<float>()) : Vec3f(Vec3f::Zero());
    for (const Float4& p : simulation.view().positions) places[moves ? 1 : 0].emplace_back(p.xyz() - shift);
  }
  float farthest = 0;
  for (const Vec3f& place : places[0]) {
    float nearest = 1;
    for (const Vec3f& other : places[1]) nearest = std::min(nearest, (place - other).norm());
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, 0.02F * static_cast<float>(kSpacing)) << "the dam has fallen over by then";
}

TEST(MovingTank, TiltedByAMotionItsWaterComesToLieLevel) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.8, 0.3, 0.3});
  auto tank = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(0.8, 0.8, 0.3), Box::Fluid::inside, Rotation{});
  Motion motion;
  motion.turns = true;
  motion.axis = Vec3d::UnitZ();
  motion.point = {0.4, 0, 0};
  motion.keyframes = {{0, Vec3d::Zero(), 0}, {1.5, Vec3d::Zero(), 15}};
  tank->motion = motion;
  scene.surfaces.push_back(tank);
  addViscosity(scene);
  Simulation simulation(scene, 2);
  for (int k = 0; k < 600; ++k) simulation.advanceFrame();
  EXPECT_FALSE(simulation.statistics().failed());
  EXPECT_EQ(simulation.statistics().maxPenetration, 0);
  // The highest particle of each column, and the line through them; the floor's slope is 0.27.
  std::map<int, double> top;
  for (const Float4& p : simulation.view().positions) {
    double& highest = top.try_emplace(static_cast<int>(std::floor(p.x / 0.1F)), -1).first->second;
    highest = std::max(highest, static_cast<double>(p.y));
  }
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [column, height] : top) {
    const double at = 0.1 * (column + 0.5);
    if (at < 0.15 || at > 0.7) continue;
    n += 1, x += at, y += height, xx += at * at, xy += at * height;
  }
  EXPECT_NEAR((n * xy - x * y) / (n * xx - x * x), 0, 0.05);
}

TEST(FastPlate, LosesNoParticleOfTheWaterItSweepsThrough) {
  for (const double cfl : {0.4, 0.0}) {
    Scene scene = emptyScene();
    scene.gravity = {0, -9.81, 0};
    scene.solver.cfl = cfl;
    addFluid(scene, {0.2, 0, 0}, {1.2, 0.3, 0.4});
    addTank(scene, Vec3d::Zero(), {1.2, 0.8, 0.4});
    // A quarter of a support radius thick, half as wide as the tank, at 5 m/s.
    scene.surfaces.push_back(block({0.1, -0.1, -0.1}, {0.125, 0.9, 0.2}, atVelocity({5, 0, 0}, 0.18)));
    addViscosity(scene);
    Simulation simulation(scene, 2);
    const std::size_t particles = simulation.view().positions.size();
    for (int k = 0; k < 60; ++k) simulation.advanceFrame();
    EXPECT_EQ(simulation.statistics().lostParticles, 0);
    EXPECT_EQ(simulation.statistics().nonfiniteParticles, 0);
    EXPECT_LT(simulation.statistics().maxPenetration, 1e-5);
    EXPECT_EQ(simulation.view().positions.size(), particles);
  }
}

TEST(FastPlate, HasTheParticlesThatWereBeforeItStillBeforeIt) {
  for (const double speed : {5.0, 50.0}) {
    for (const double thickness : {0.025, 0.2}) {
      Scene scene = emptyScene();
      scene.solver.cfl = 0;  // no substeps: it passes whole layers in one move
      addFluid(scene, {0.3, 0.2, 0.1}, {0.45, 0.35, 0.25});
      scene.surfaces.push_back(block({0.2 - thickness, -9, -9}, {0.2, 9, 9}, atVelocity({speed, 0, 0})));
      Simulation simulation(scene, 1);
      for (int k = 1; k <= 40; ++k) {
        simulation.advanceFrame();
        const double face = 0.2 + speed * simulation.time();
        for (const Float4& p : simulation.view().positions)
          ASSERT_GE(static_cast<double>(p.x), face + 0.5 * kSpacing - 1e-5) << speed << " m/s, frame " << k;
      }
      // By then it has caught up with all: they are as fast as the plate, and no faster than from a bounce.
      for (const Float4& v : simulation.view().velocities) {
        EXPECT_GE(static_cast<double>(v.x), 0.99 * speed);
        EXPECT_LE(static_cast<double>(v.x), 2 * speed);
      }
    }
  }
}

/// A block that counts how often its drawing is made.
class CountedBlock final : public Surface {
 public:
  CountedBlock(const Vec3d& min, const Vec3d& max) : box_(min, max, Box::Fluid::outside) {}

  void describe(FieldVisitor&) override {}
  void describe(FieldWriter&) const override {}
  float distance(const Vec3f& p, Vec3f& normal) const override { return box_.distance(p, normal); }
  bool project(Vec3f& p, float margin) const override { return box_.project(p, margin); }
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override {
    box_.firstHits(origin, directions, hits);
  }
  Bounds bounds() const override { return box_.bounds(); }
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override {
    ++drawings_;
    box_.wireframe(scene, out);
  }
  int drawings() const { return drawings_; }

 private:
  Box box_;
  mutable int drawings_ = 0;
};

TEST(MovingWall, IsDrawnOnlyForThoseWhoLook) {
  Scene scene = smallDamBreak();
  Simulation still(scene, 1);
  EXPECT_EQ(still.drawnView().walls, nullptr) << "that nothing moves is known from the start";

  const auto wall = std::make_shared<CountedBlock>(Vec3d(-0.2, 0, 0), Vec3d(-0.1, 0.8, 0.3));
  wall->motion = atVelocity({0.5, 0, 0});
  scene.surfaces = {wall};
  Simulation simulation(scene, 1);
  for (int k = 0; k < 5; ++k) simulation.advanceFrame();
  EXPECT_EQ(simulation.view().walls, nullptr);
  EXPECT_EQ(wall->drawings(), 0);

  std::shared_ptr<const WallDrawing> before;
  for (int k = 1; k <= 3; ++k) {
    simulation.advanceFrame();
    FrameSnapshot snapshot;
    snapshot.assign(simulation.drawnView());
    EXPECT_EQ(snapshot.view().walls, simulation.drawnView().walls) << "made once a frame";
    EXPECT_EQ(wall->drawings(), k);
    ASSERT_NE(snapshot.walls, nullptr);
    EXPECT_NE(snapshot.walls, before);
    before = snapshot.walls;
    // The twelve edges of a block, of which every corner is an end of three.
    ASSERT_EQ(snapshot.walls->lines.size(), 12U);
    double sum = 0;
    for (const LineSegment& line : snapshot.walls->lines)
      sum += 0.5 * static_cast<double>(line.from.x() + line.to.x());
    EXPECT_NEAR(sum / 12, -0.15 + 0.5 * simulation.time(), 1e-6);
  }
}

}  // namespace moving_wall_test
}  // namespace migiwa
