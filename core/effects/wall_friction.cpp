// Coulomb friction at the walls, on positions as in Macklin et al. 2014 (Unified Particle Physics): whenever
// a wall pushes a particle by d along its normal, the particle's slip along the wall since the start of the
// step is taken back by up to mu d. Slip is relative to the wall, so that a wall that moves drags the fluid
// along. A step's pushes add up to what a wall has to bear in it, hence the fluid is braked by mu times its
// weight. METHOD: the wall pushes where it keeps a particle in and by the gamma term of the position step.
#include <algorithm>

#include "core/effects/effects.h"
#include "core/solver/step_state.h"

namespace migiwa {

namespace {

class WallFriction final : public Effect {
 public:
  void describe(FieldVisitor& visitor) override {
    visitor.number("coefficient", coefficient_, Range::closed(0, 10),
                   {"1", "Largest friction over the push of the wall, mu."});
  }
  std::unique_ptr<Effect> clone() const override { return std::make_unique<WallFriction>(*this); }
  EffectStages stages() const override {
    return {.prediction = coefficient_ > 0, .iteration = coefficient_ > 0};
  }

  /// The prediction was kept in already: what that pushed is seen from where it would have gone.
  void changePrediction(StepState& state, std::span<EffectBuffer>) const override {
    if (state.boundary.empty()) return;
    const Particles& particles = state.particles;
    parallelFor(state.pool, particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3f free = particles.position[i].xyz() + state.timeStep * particles.velocity[i].xyz();
        const Vec3f push = state.current[i].xyz() - free;
        if (push.squaredNorm() > 0) brake(state, i, push);
      }
    });
  }

  void changePositions(StepState& state, float weight) const override {
    const bool wallTerm = state.parameters.positionStep != PositionStep::paper;
    parallelFor(state.pool, state.wallSlots.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t k = begin; k < end; ++k) {
        const WallSlot& slot = state.wallSlots[k];
        const std::uint32_t i = slot.particle;
        Vec3f kept = state.current[i].xyz();
        state.boundary.project(kept, state.wallMargin());
        Vec3f push = kept - state.current[i].xyz();
        if (wallTerm) push -= weight * state.supportRadius * state.wallPush(i) * slot.sample.pairGradient;
        if (push.squaredNorm() > 0) brake(state, i, push);
      }
    });
  }

 private:
  void brake(StepState& state, std::size_t i, const Vec3f& push) const {
    const Vec3f at = state.current[i].xyz();
    Vec3f normal;
    state.boundary.distance(at, normal);
    const float along = push.dot(normal);
    if (along <= 0) return;
    Vec3f slip = at - state.particles.position[i].xyz() - state.timeStep * state.boundary.wallVelocity(at);
    slip -= slip.dot(normal) * normal;
    const float length = slip.norm();
    if (length == 0) return;
    const float part = std::min(1.0F, static_cast<float>(coefficient_) * along / length);
    state.current[i].setXyz(at - part * slip);
  }

  double coefficient_ = 0.3;
};

}  // namespace

std::unique_ptr<Effect> makeWallFriction() {
  return std::make_unique<WallFriction>();
}

}  // namespace migiwa
