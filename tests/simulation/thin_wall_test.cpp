// A plate thinner than the support radius: what is on one side knows nothing of the other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/solver/step.h"
#include "core/walls/shapes.h"
#include "core/walls/slim_wall.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace thin_wall_test {

using namespace migiwa::testing;

constexpr double kThickness = 0.025;  // a quarter of the support radius
constexpr double kSide = 0.4;

/// A tank that a plate parts in two, each side `kSide` wide and filled to its own height (0: empty).
Scene partedTank(double leftHeight, double rightHeight) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  const double width = 2 * kSide + kThickness;
  if (leftHeight > 0) addFluid(scene, Vec3d::Zero(), {kSide, leftHeight, kSide});
  if (rightHeight > 0) addFluid(scene, {kSide + kThickness, 0, 0}, {width, rightHeight, kSide});
  addTank(scene, Vec3d::Zero(), {width, 0.8, kSide});
  scene.surfaces.push_back(std::make_shared<Box>(Vec3d(kSide, 0, 0), Vec3d(kSide + kThickness, 0.8, kSide),
                                                 Box::Fluid::outside, Rotation{}));
  addViscosity(scene);
  return scene;
}

constexpr float kPlate = static_cast<float>(kSide + 0.5 * kThickness);

long leftOfPlate(const FrameView& view) {
  long count = 0;
  for (const Float4& p : view.positions) count += p.x < kPlate ? 1 : 0;
  return count;
}

TEST(ThinWall, NothingPassesUnderAHeadOfWater) {
  Simulation simulation(partedTank(0.6, 0.15), 2);
  const long left = leftOfPlate(simulation.view());
  ASSERT_EQ(left, 8 * 12 * 8);
  for (int k = 0; k < 300; ++k) {
    simulation.advanceFrame();
    ASSERT_EQ(leftOfPlate(simulation.view()), left) << "frame " << k;
  }
  EXPECT_EQ(simulation.statistics().maxPenetration, 0);
  EXPECT_FALSE(simulation.statistics().failed());
}

TEST(ThinWall, ASideIsAsIfItWereAlone) {
  // The same number of iterations in both runs, for its choice looks at all particles together.
  Scene both = partedTank(0.4, 0.3), alone = partedTank(0.4, 0);
  for (Scene* scene : {&both, &alone})
    scene->solver.minIterations = scene->solver.maxIterations = 4, scene->solver.tolerance = 0;
  Simulation parted(both, 1), single(alone, 1);
  for (int k = 0; k < 5; ++k) {
    parted.advanceFrame();
    single.advanceFrame();
  }
  // The grid lies differently, so that sums are rounded differently.
  long compared = 0;
  for (const Float4& p : parted.view().positions) {
    if (p.x > kPlate) continue;
    float nearest = 1;
    for (const Float4& q : single.view().positions) nearest = std::min(nearest, (p.xyz() - q.xyz()).norm());
    EXPECT_LT(nearest, 1e-4F * static_cast<float>(kSpacing));
    ++compared;
  }
  EXPECT_EQ(compared, 8 * 8 * 8);
}

TEST(ThinWall, AFastParticleIsHeldOnTheSideThatItComesFrom) {
  for (const double speed : {5.0, 50.0, 500.0}) {
    Scene scene = partedTank(0, 0);
    scene.gravity.setZero();
    addFluid(scene, {0.1, 0.2, 0.1}, {0.25, 0.35, 0.25}, {speed, 0.1 * speed, 0});
    scene.solver.cfl = 0;  // no substeps: the plate is crossed in one move
    Simulation simulation(scene, 1);
    for (int k = 0; k < 20; ++k) {
      simulation.advanceFrame();
      for (const Float4& p : simulation.view().positions)
        ASSERT_LE(p.x, static_cast<float>(kSide - 0.5 * kSpacing) + 1e-5F) << speed << " m/s, frame " << k;
    }
  }
}

TEST(ThinWall, AMoveThatIsHeldBackGoesOnAlongTheWall) {
  const Scene scene = partedTank(0, 0);
  const Boundary boundary(scene.surfaces);
  const auto walls = thinWalls(boundary, 0.1F);
  ASSERT_EQ(walls.all().size(), 1U);
  EXPECT_TRUE(thinWalls(boundary, 0.02F).empty()) << "the plate is thicker than that";
  const Vec3f from(0.37F, 0.2F, 0.1F), to(0.5F, 0.3F, 0.15F);
  const Vec3f held = clipMove(walls, from, false, to, 0.025F);
  EXPECT_NEAR(held.x(), 0.375F, 1e-6F);
  EXPECT_FLOAT_EQ(held.y(), to.y());
  EXPECT_FLOAT_EQ(held.z(), to.z());
  EXPECT_EQ(clipMove(walls, from, false, Vec3f(0.3F, 0.2F, 0.1F), 0.025F), Vec3f(0.3F, 0.2F, 0.1F));
}

/// The least distance to a wall (m) on the way from one point to another, by walking there in small steps.
float leastOnTheWay(const Boundary& walls, const Vec3f& from, const Vec3f& to) {
  constexpr int kSteps = 400;
  float least = std::numeric_limits<float>::infinity();
  for (int k = 0; k <= kSteps; ++k)
    least = std::min(least, walls.distance(from + static_cast<float>(k) / kSteps * (to - from)));
  return least;
}

TEST(ThinWall, NeighboursAreThoseThatBlocksDoNotHide) {
  // Against walking from each to each. Upright blocks enough for a grid, and one that is turned.
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (int k = 0; k < 14; ++k) {
    const Vec3d low(0.08 * (k % 5), 0.13 * (k / 5 % 3), 0.05 + 0.02 * (k % 3));
    const Vec3d size(k % 2 == 0 ? 0.01 : 0.05, 0.04, k % 3 == 0 ? 0.15 : 0.02);
    surfaces.push_back(std::make_shared<Box>(low, low + size, Box::Fluid::outside,
                                             k == 7 ? Rotation{{1, 2, 0}, 40} : Rotation{}));
  }
  const Boundary boundary(surfaces);
  ThreadPool pool(2);
  StepState state(pool, boundary);
  state.parameters.takeVelocities(VelocityStep::positions);
  state.spacing = 0.05F, state.supportRadius = 0.1F, state.timeStep = 0.005F;
  state.lattice = restingLattice(state.parameters.kernel, state.parameters.supportRatio);
  for (std::uint32_t id = 0; id < 700; ++id) {
    Vec3f p(0.45F * unit(random), 0.4F * unit(random), 0.25F * unit(random));
    boundary.project(p, 0.001F);
    state.particles.position.emplace_back(p);
    state.particles.velocity.emplace_back();
    state.particles.id.push_back(id);
  }
  const auto pairs = [&] {
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (std::size_t i = 0; i < state.particles.size(); ++i)
      for (const std::uint32_t j : state.neighbours.of(i))
        found.emplace(state.particles.id[i], state.particles.id[j]);
    return found;
  };
  prepareFields(state);
  std::vector<Vec3f> place(state.particles.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    place[state.particles.id[i]] = state.particles.position[i].xyz();
  std::map<std::pair<std::uint32_t, std::uint32_t>, float> least;
  for (const auto& [i, j] : pairs())
    if (i < j) least[{i, j}] = leastOnTheWay(boundary, place[i], place[j]);
  state.thinWalls = thinWalls(boundary, state.supportRadius);
  ASSERT_EQ(state.thinWalls.all().size(), surfaces.size());
  // The second time it is known how far from walls particles are.
  for (int round = 0; round < 2; ++round) {
    prepareFields(state);
    const auto kept = pairs();
    int hidden = 0, seen = 0;
    for (const auto& [pair, distance] : least) {
      const auto& [i, j] = pair;
      if (std::abs(distance) < 2e-4F) continue;  // along a face, or past an edge
      ++(distance < 0 ? hidden : seen);
      ASSERT_TRUE(kept.contains({i, j}) == (distance > 0) && kept.contains({j, i}) == (distance > 0))
          << "round " << round << ", from " << place[i].transpose() << " to " << place[j].transpose();
    }
    EXPECT_GT(hidden, 500);
    EXPECT_GT(seen, 1000);
  }
}

TEST(ThinWall, FastWaterStaysInAThinBowlOfAnyShape) {
  // The wall is a third of the support radius thick, and a step takes the water five times as far.
  SlimSource source;
  source.kind = SlimSource::Kind::bowl;
  source.bowl = {Vec3d::Zero(), 0.5, 0.03};
  source.degree = 2;
  source.nodes = 1500;
  const auto data = prepareSlim(source);
  EXPECT_NEAR(data->thinnestPart, 0.03, 0.003);
  Scene scene = emptyScene();
  scene.surfaces.push_back(std::make_shared<SlimSurface>(data, SlimSurface::Fluid::outside));
  addFluid(scene, {-0.15, -0.3, -0.15}, {0.15, 0, 0.15}, {0, -30, 0});
  scene.solver.cfl = 0;
  Simulation simulation(scene, 2);
  for (int k = 0; k < 20 && !simulation.stopped(); ++k) {
    simulation.advanceFrame();
    for (const Float4& p : simulation.view().positions) {
      const Vec3d at = p.xyz().cast<double>();
      ASSERT_FALSE(at.y() < 0 && at.norm() > 0.5) << "frame " << k << ": " << at.transpose();
    }
  }
  EXPECT_FALSE(simulation.stopped());
}

}  // namespace thin_wall_test
}  // namespace migiwa
