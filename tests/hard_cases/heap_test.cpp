// Heaps, many particles where one has room, are spread before their pairs are listed: as many neighbours a
// particle as at rest, whatever lies there, and no momentum from it.
#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "tests/support/free_fluid.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace heap_test {

class PointSource final : public FluidSource {
 public:
  PointSource(const Vec3d& point, std::size_t particles) : point_(point), particles_(particles) {}
  void describe(FieldVisitor&) override {}
  void describe(FieldWriter&) const override {}
  double count(double) const override { return static_cast<double>(particles_); }
  void fill(double, std::vector<Vec3d>& out) const override { out.assign(particles_, point_); }
  Bounds bounds() const override {
    Bounds bounds;
    bounds.include(point_);
    return bounds;
  }

 private:
  Vec3d point_;
  std::size_t particles_;
};

double listedPerParticle(const StepState& state) {
  double listed = 0;
  for (const std::uint32_t count : state.neighbours.counts()) listed += count;
  return listed / static_cast<double>(state.particles.size());
}

const Trouble* heapOf(const Simulation& simulation) {
  for (const Trouble& trouble : simulation.statistics().trouble)
    if (trouble.kind == "heap") return &trouble;
  return nullptr;
}

void expectAsManyNeighboursAsAtRest(const Simulation& simulation) {
  for (const std::uint32_t count : simulation.view().neighbours) EXPECT_LT(count, 100U);
}

TEST(Heaps, HaveAsManyNeighboursAParticleAsAtRest) {
  const double resting = [] {
    FreeFluid lattice(latticePlaces(20, 0), [](const Vec3f&) { return Vec3f(Vec3f::Zero()); });
    return listedPerParticle(lattice.state());
  }();
  for (const std::size_t particles : {2000U, 8000U, 50000U}) {
    FreeFluid heap(std::vector<Vec3f>(particles, Vec3f(1, 2, 3)),
                   [](const Vec3f&) { return Vec3f(Vec3f::Zero()); });
    EXPECT_LT(listedPerParticle(heap.state()), 1.5 * resting) << particles;
    // All that the search has ever had room for.
    EXPECT_LT(static_cast<double>(heap.state().neighbours.bytes()) / static_cast<double>(particles),
              3 * resting * sizeof(std::uint32_t))
        << particles;
    EXPECT_EQ(heap.state().spreadParticles, static_cast<long>(particles));
    Vec3d centre = Vec3d::Zero();
    for (const Float4& p : heap.state().particles.position) centre += p.xyz().cast<double>();
    centre /= static_cast<double>(particles);
    EXPECT_LT((centre - Vec3d(1, 2, 3)).norm(), 1e-6) << particles;
  }
}

TEST(Heaps, FarFromAllOthersAreSpreadToo) {
  // The grid's cells are then metres wide.
  std::vector<Vec3f> places(1000, Vec3f(Vec3f::Zero()));
  places.emplace_back(1000, 1000, 1000);
  FreeFluid heap(places, [](const Vec3f&) { return Vec3f(Vec3f::Zero()); });
  EXPECT_EQ(heap.state().spreadParticles, 1000);
  for (const std::uint32_t count : heap.state().neighbours.counts()) EXPECT_LT(count, 100U);
  EXPECT_EQ(heap.state().particles.position.back().xyz(), Vec3f(1000, 1000, 1000));
}

TEST(Heaps, OfAStepConserveMomentum) {
  // A cube that falls into one point within a step.
  constexpr int kSide = 12;
  FreeFluid fluid(latticePlaces(kSide, 0.2F),
                  [](const Vec3f& place) { return Vec3f(Vec3f(1, 0, 0) - place / 0.005F); });
  StepState& state = fluid.state();
  Vec3d before = Vec3d::Zero();
  double speeds = 0;
  for (const Float4& v : state.particles.velocity) {
    before += v.xyz().cast<double>();
    speeds += static_cast<double>(v.xyz().norm());
  }
  EffectPipeline none;
  ASSERT_FALSE(advanceStep(state, none).any());
  EXPECT_EQ(state.spreadParticles, kSide * kSide * kSide);
  Vec3d after = Vec3d::Zero();
  for (const Float4& v : state.particles.velocity) after += v.xyz().cast<double>();
  EXPECT_LT((after - before).norm(), 1e-4 * speeds);
  for (const std::uint32_t count : state.neighbours.counts()) EXPECT_LT(count, 100U);
}

TEST(Heaps, OfTheStartAreNamedAndStayAtRest) {
  Scene scene = emptyScene();
  scene.fluid.push_back(std::make_shared<PointSource>(Vec3d(1, 2, 3), 3000));
  std::uint64_t hash = 0;
  for (const int threads : {1, 3}) {
    Simulation simulation(scene, threads);
    const Trouble* const heap = heapOf(simulation);
    ASSERT_NE(heap, nullptr);
    EXPECT_EQ(heap->step, 0);
    EXPECT_NE(heap->detail.find("3000 particles"), std::string::npos) << heap->detail;
    for (const Float4& v : simulation.view().velocities) EXPECT_EQ(v.xyz().norm(), 0);
    expectAsManyNeighboursAsAtRest(simulation);
    for (int frame = 0; frame < 3; ++frame) simulation.advanceFrame();
    if (threads == 1) hash = simulation.stateHash();
    EXPECT_EQ(simulation.stateHash(), hash);
  }
}

TEST(Heaps, ThatWallsMakeInARunAreSpreadWithinThem) {
  // Far too fast for its step: all of the block is predicted beyond the corner, which is the place for it
  // all.
  Scene scene = emptyScene();
  addTank(scene, Vec3d::Zero(), {3, 3, 3});
  addFluid(scene, {0.5, 0.5, 0.5}, {1, 1, 1}, {-1000, -1000, -1000});
  scene.solver.cfl = 0;
  std::uint64_t hash = 0;
  for (const int threads : {1, 3}) {
    Simulation simulation(scene, threads);
    EXPECT_EQ(heapOf(simulation), nullptr);
    simulation.advanceFrame();
    const Trouble* const heap = heapOf(simulation);
    ASSERT_NE(heap, nullptr);
    EXPECT_EQ(heap->step, 1);
    EXPECT_NE(heap->detail.find("1000 particles"), std::string::npos) << heap->detail;
    expectAsManyNeighboursAsAtRest(simulation);
    EXPECT_EQ(simulation.statistics().lostParticles, 0);
    EXPECT_LE(simulation.statistics().maxPenetration, 0);
    if (threads == 1) hash = simulation.stateHash();
    EXPECT_EQ(simulation.stateHash(), hash);
  }
}

}  // namespace heap_test
}  // namespace migiwa::testing
