// A wall that stands still gives no speed to what begins within it, and a step that is refused leaves even
// that where it began.
#include <algorithm>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "core/solver/step.h"
#include "core/sph/kernels.h"
#include "core/walls/boundary.h"
#include "core/walls/shapes.h"

namespace migiwa::testing {
namespace wall_jump_test {

constexpr float kSpacing = 0.125F, kStep = 0.0078125F;

/// A floor, a particle that begins within it, and a fast one in the air.
class StepAtFloor {
 public:
  StepAtFloor() : floor_({std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY())}), state_(pool_, floor_) {
    state_.spacing = kSpacing;
    state_.parameters.takeVelocities(VelocityStep::positions);
    state_.supportRadius = static_cast<float>(state_.parameters.supportRatio) * kSpacing;
    state_.lattice = restingLattice(state_.parameters.kernel, state_.parameters.supportRatio);
    state_.timeStep = kStep;
    add({3, 5, 3}, {0, 1, 0});
    add(kWithin, Vec3f::Zero());
  }

  void add(const Vec3f& position, const Vec3f& velocity) {
    state_.particles.id.push_back(static_cast<std::uint32_t>(state_.particles.size()));
    state_.particles.position.emplace_back(position);
    state_.particles.velocity.emplace_back(velocity);
  }
  StepRefusal advance() {
    EffectPipeline none;
    return advanceStep(state_, none);
  }
  std::size_t indexOf(std::uint32_t id) const {
    const auto& ids = state_.particles.id;
    return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
  }
  Vec3f positionOf(std::uint32_t id) const { return state_.particles.position[indexOf(id)].xyz(); }
  Vec3f velocityOf(std::uint32_t id) const { return state_.particles.velocity[indexOf(id)].xyz(); }
  const StepState& state() const { return state_; }

  static inline const Vec3f kWithin{0.5F, -0.25F, 0.5F};

 private:
  ThreadPool pool_{2};
  Boundary floor_;
  StepState state_;
};

TEST(WallJump, GivesNoSpeed) {
  StepAtFloor step;
  ASSERT_FALSE(step.advance().any());
  EXPECT_FLOAT_EQ(step.positionOf(1).y(), kSpacing / 2);
  // A hundredth of the margin a step is what a particle at a wall may stand too near to it.
  EXPECT_LE(step.velocityOf(1).norm(), 0.0101F * kSpacing / 2 / kStep);
  EXPECT_EQ(step.state().suppressedPushes.size(), 1U);
}

TEST(WallJump, OfARefusedStepIsTakenBack) {
  StepAtFloor step;
  step.add({9, 5, 9}, {0, std::numeric_limits<float>::quiet_NaN(), 0});
  ASSERT_TRUE(step.advance().notFinite);
  EXPECT_EQ(step.positionOf(1), StepAtFloor::kWithin);
  EXPECT_EQ(step.velocityOf(1), Vec3f::Zero());
  EXPECT_EQ(step.positionOf(0), Vec3f(3, 5, 3));
  EXPECT_TRUE(step.state().suppressedPushes.empty());
}

}  // namespace wall_jump_test
}  // namespace migiwa::testing
