// Taking back energy that a step made from nothing, against sums by hand: where it was gained, no more than
// that, and no momentum with it.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/solver/step.h"
#include "core/sph/kernels.h"
#include "core/walls/boundary.h"

namespace migiwa::testing {
namespace hold_energy_test {

constexpr float kSpacing = 0.0625F, kStep = 0.001953125F;
constexpr int kEdge = 5;
constexpr std::uint32_t kBlock = kEdge * kEdge * kEdge;

/// Two blocks that fly into each other, solved in one iteration, which makes energy; and far off two that
/// meet slowly, and one that falls alone.
class Blocks {
 public:
  explicit Blocks(int threads) : pool_(threads), state_(pool_, none_) {
    state_.parameters.minIterations = state_.parameters.maxIterations = 1;
    state_.parameters.tolerance = 0.1;
    state_.parameters.kernel = KernelType::wendlandC2;
    state_.parameters.acceleration = Acceleration::none;
    state_.spacing = kSpacing;
    state_.parameters.takeVelocities(VelocityStep::positions);
    state_.supportRadius = static_cast<float>(state_.parameters.supportRatio) * kSpacing;
    state_.lattice = restingLattice(state_.parameters.kernel, state_.parameters.supportRatio);
    state_.timeStep = kStep;
    state_.gravity = Vec3f(0, -8, 0);
    constexpr float kWide = kEdge * kSpacing;
    add({-kWide, 0, 0}, {24, 0, 0});
    add({0.02F, 0.03F, 0.01F}, {-24, 0, 0});
    add({8 - kWide, 0, 0}, {1, 0, 0});
    add({8.02F, 0, 0}, {-1, 0, 0});
    add({0, 8, 0}, {0, -3, 0});
  }

  /// Steps until one has gained energy; returns how much, or 0 after too many.
  double advanceToGain() {
    for (int step = 0; step < 20; ++step) {
      const double before = energy();
      EffectPipeline none;
      if (advanceStep(state_, none).any()) return 0;
      if (const double gained = energy() - before; gained > 1e-3 * before) return gained;
    }
    return 0;
  }
  HeldEnergy hold(double excess) {
    EffectPipeline none;
    return holdEnergy(state_, none, excess);
  }
  double energy() const {
    const Vec3d gravity = state_.gravity.cast<double>();
    double sum = 0;
    for (std::size_t i = 0; i < state_.particles.size(); ++i) {
      const Vec3d velocity =
          state_.particles.velocity[i].xyz().cast<double>() + 0.5 * static_cast<double>(kStep) * gravity;
      sum += 0.5 * velocity.squaredNorm() - gravity.dot(state_.particles.position[i].xyz().cast<double>());
    }
    return sum;
  }
  /// By the number that each began with.
  std::vector<Vec3f> velocities() const {
    std::vector<Vec3f> list(state_.particles.size());
    for (std::size_t i = 0; i < list.size(); ++i)
      list[state_.particles.id[i]] = state_.particles.velocity[i].xyz();
    return list;
  }

 private:
  void add(const Vec3f& corner, const Vec3f& velocity) {
    for (std::uint32_t k = 0; k < kBlock; ++k) {
      const Vec3f cell(static_cast<float>(k % kEdge), static_cast<float>(k / kEdge % kEdge),
                       static_cast<float>(k / kEdge / kEdge));
      state_.particles.id.push_back(static_cast<std::uint32_t>(state_.particles.size()));
      state_.particles.position.emplace_back(Vec3f(corner + kSpacing * cell));
      state_.particles.velocity.emplace_back(velocity);
    }
  }

  ThreadPool pool_;
  Boundary none_{{}};
  StepState state_;
};

Vec3d momentumOf(const std::vector<Vec3f>& velocities, std::size_t first, std::size_t end) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = first; i < end; ++i) sum += velocities[i].cast<double>();
  return sum;
}

TEST(HoldEnergy, TakesWhatWasGainedWhereItWasGainedAndNoMomentum) {
  for (const double part : {0.1, 0.5, 1.0}) {
    Blocks blocks(2);
    const double gained = blocks.advanceToGain();
    ASSERT_GT(gained, 0);
    const double after = blocks.energy();
    const std::vector<Vec3f> before = blocks.velocities();
    const HeldEnergy held = blocks.hold(part * gained);
    EXPECT_NEAR(held.taken, part * gained, 1e-5 * gained) << part;
    EXPECT_NEAR(after - blocks.energy(), part * gained, 1e-4 * gained) << part;
    const std::vector<Vec3f> now = blocks.velocities();
    EXPECT_LT((momentumOf(now, 0, 2 * kBlock) - momentumOf(before, 0, 2 * kBlock)).norm(), 1e-3)
        << "of " << 24 * kBlock << " m/s that each block brought";
    EXPECT_TRUE(std::equal(now.begin() + 2 * kBlock, now.end(), before.begin() + 2 * kBlock))
        << "who had no part in it keeps every bit";
    EXPECT_LE(held.particles, 2 * kBlock);
    EXPECT_GT(held.particles, 0U);
  }
}

TEST(HoldEnergy, TakesNoMoreThanTheSolveHasMade) {
  Blocks blocks(2);
  const double gained = blocks.advanceToGain(), after = blocks.energy();
  ASSERT_GT(gained, 0);
  const std::vector<Vec3f> before = blocks.velocities();
  const HeldEnergy held = blocks.hold(1e9);
  EXPECT_NEAR(after - blocks.energy(), held.taken, 1e-4 * held.taken);
  EXPECT_LT(held.taken, 2.0 * 24 * 24 * kBlock);
  const std::vector<Vec3f> now = blocks.velocities();
  EXPECT_LT((momentumOf(now, 0, 2 * kBlock) - momentumOf(before, 0, 2 * kBlock)).norm(), 1e-3);
}

TEST(HoldEnergy, IsTheSameForAnyNumberOfThreads) {
  std::vector<std::vector<Vec3f>> ends;
  for (const int threads : {1, 2, 5}) {
    Blocks blocks(threads);
    blocks.hold(blocks.advanceToGain());
    ends.push_back(blocks.velocities());
  }
  EXPECT_EQ(ends[0], ends[1]);
  EXPECT_EQ(ends[0], ends[2]);
}

TEST(HoldEnergy, LeavesAStepThatTheSolveDidNotChange) {
  Blocks blocks(1);
  ASSERT_GT(blocks.advanceToGain(), 0);
  const std::vector<Vec3f> before = blocks.velocities();
  EXPECT_EQ(blocks.hold(0).particles, 0U);
  EXPECT_EQ(blocks.velocities(), before);
}

}  // namespace hold_energy_test
}  // namespace migiwa::testing
