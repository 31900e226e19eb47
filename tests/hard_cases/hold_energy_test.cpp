// Taking back energy that a step made from nothing, against sums by hand: what is asked for, or the least
// that scaling can reach, and no momentum from it.
#include "core/solver/hold_energy.h"

#include <random>

#include <gtest/gtest.h>

#include "core/boundary/boundary.h"

namespace migiwa::testing {
namespace {

constexpr std::size_t kParticles = 200;
constexpr double kStep = 0.0078125;  // a power of two: ways over it are exact

/// A finished step of particles that flew at random and were pushed in pairs.
class FinishedStep {
 public:
  explicit FinishedStep(double push) : pool_(2), state_(pool_, none_) {
    std::mt19937 engine(7);
    const auto random = [&] {
      const auto one = [&] { return static_cast<float>(engine() % 1024) / 512 - 1; };
      return Vec3f(one(), one(), one());
    };
    state_.timeStep = static_cast<float>(kStep);
    state_.gravity = Vec3f(0, -8, 0);
    Vec3f last = Vec3f::Zero();
    for (std::size_t i = 0; i < kParticles; ++i) {
      const Vec3f from = random(), predicted = random();
      const Vec3f change = i % 2 == 0 ? Vec3f(static_cast<float>(push) * random()) : Vec3f(-last);
      last = change;
      state_.before.position.emplace_back(from);
      state_.before.velocity.emplace_back(predicted);
      state_.particles.position.emplace_back(Vec3f(from + state_.timeStep * (predicted + change)));
      state_.particles.velocity.emplace_back(Vec3f(predicted + change));
      state_.particles.id.push_back(static_cast<std::uint32_t>(i));
    }
  }

  double hold(double excess) {
    EffectPipeline none;
    return holdEnergy(state_, none, excess);
  }
  /// Kinetic and potential energy half a step on, with `share` of what the solve has changed of velocities.
  double energy(double share) const {
    double sum = 0;
    for (std::size_t i = 0; i < kParticles; ++i) {
      const Vec3d before = state_.before.velocity[i].xyz().cast<double>();
      const Vec3d solved =
          Vec3f(state_.particles.position[i].xyz() - state_.before.position[i].xyz()).cast<double>() / kStep;
      sum += energyOf(i, before + share * (solved - before));
    }
    return sum;
  }
  double energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < kParticles; ++i)
      sum += energyOf(i, state_.particles.velocity[i].xyz().cast<double>());
    return sum;
  }
  Vec3d momentum() const {
    Vec3d sum = Vec3d::Zero();
    for (const Float4& v : state_.particles.velocity) sum += v.xyz().cast<double>();
    return sum;
  }

 private:
  double energyOf(std::size_t i, const Vec3d& velocity) const {
    const Vec3d gravity = state_.gravity.cast<double>();
    return 0.5 * (velocity + 0.5 * kStep * gravity).squaredNorm() -
           gravity.dot(state_.particles.position[i].xyz().cast<double>());
  }

  ThreadPool pool_;
  Boundary none_{{}};
  StepState state_;
};

TEST(HoldEnergy, TakesWhatIsAskedForAndNoMomentum) {
  for (const double part : {0.01, 0.5, 1.0}) {
    FinishedStep step(3);
    const double before = step.energy(), asked = part * (before - step.energy(0));
    ASSERT_GT(asked, 0);
    const Vec3d momentum = step.momentum();
    const double factor = step.hold(asked);
    EXPECT_NEAR(step.energy(), before - asked, 1e-4 * before) << part;
    EXPECT_NEAR(step.energy(), step.energy(factor), 1e-4 * before) << part;
    EXPECT_LT((step.momentum() - momentum).norm(), 1e-4) << part;
  }
}

TEST(HoldEnergy, TakesNoMoreThanScalingReaches) {
  FinishedStep step(3);
  double least = step.energy();
  for (int share = 0; share <= 1000; ++share) least = std::min(least, step.energy(0.001 * share));
  step.hold(10 * step.energy());
  EXPECT_NEAR(step.energy(), least, 1e-4 * std::abs(least));
}

TEST(HoldEnergy, LeavesAStepThatTheSolveDidNotChange) {
  FinishedStep step(0);
  const double before = step.energy();
  EXPECT_EQ(step.hold(1), 1);
  EXPECT_EQ(step.energy(), before);
}

}  // namespace
}  // namespace migiwa::testing
