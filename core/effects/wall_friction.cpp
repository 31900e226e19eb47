// Coulomb friction at the walls, on positions as in Macklin et al. 2014 (Unified Particle Physics): whenever
// a wall pushes a particle by d along its normal, the particle's slip along the wall since the start of the
// step is taken back by up to mu d. Slip is relative to the wall, so that a wall that moves drags the fluid
// along. In corners the push is shared out among the walls within reach, and each brakes by its own share. A
// step's pushes add up to what a wall has to bear in it, hence the fluid is braked by mu times its
// weight. METHOD: the wall pushes where it keeps a particle in and by the gamma term of the position step.
#include <algorithm>

#include "core/effects/effects.h"
#include "core/solver/state.h"

namespace migiwa {

namespace {

/// A wall within reach of a particle.
struct Contact {
  Vec3f normal;  ///< unit, into the fluid
  Vec3f move;    ///< of the wall in this step (m)
  float push;    ///< along the normal (m)
};

/// Square of the part of a push that may lie across the nearest wall's normal before other walls are asked.
constexpr float kOneWall = 1e-4F;
/// Of a position in float.
constexpr float kRounding = 2.5e-7F;

/// All walls within reach, as planes, none of them pushing yet.
void contactsAt(const StepState& state, const Vec3f& at, std::vector<Contact>& contacts) {
  thread_local std::vector<WallPiece> pieces;
  contacts.clear();
  for (const auto& surface : state.boundary.surfaces()) {
    pieces.clear();
    surface->pieces(at, state.supportRadius, pieces);
    const Vec3f move = state.timeStep * surface->velocity(at);
    for (const WallPiece& piece : pieces) contacts.push_back({piece.normal, move, 0});
  }
}

/// Shares a push out among the walls, each of which only pushes along its normal: the shares, none of them
/// negative, whose sum comes nearest to it, by the projected Gauss-Seidel method.
void share(const Vec3f& push, std::span<Contact> contacts) {
  constexpr int kRounds = 16;
  Vec3f left = push;
  for (int round = 0; round < kRounds; ++round) {
    for (Contact& contact : contacts) {
      const float now = std::max(0.0F, contact.push + left.dot(contact.normal));
      left -= (now - contact.push) * contact.normal;
      contact.push = now;
    }
  }
}

class WallFriction final : public EffectOf<WallFriction> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.number("coefficient", self.coefficient_, Range::closed(0, 10),
                   {"1", "Largest friction over the push of the wall, mu."});
  }

  EffectStages stages() const override {
    return {.prediction = coefficient_ > 0, .iteration = coefficient_ > 0};
  }

  /// The prediction was kept in already: what that pushed is seen from where it would have gone. Other
  /// effects may have moved it since, which is no push of a wall.
  void changePrediction(StepState& state, std::span<EffectBuffer>) const override {
    if (state.boundary.empty()) return;
    const Particles& particles = state.particles;
    parallelFor(state.pool, particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3f free = particles.position[i].xyz() + state.timeStep * particles.velocity[i].xyz();
        if (state.current[i].xyz() == free) continue;
        Vec3f kept = free;
        if (state.boundary.project(kept, state.wallMargin())) brake(state, i, kept - free);
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
    Vec3f slip = at - state.particles.position[i].xyz();
    Vec3f normal;
    state.boundary.distance(at, normal);
    const float along = push.dot(normal);
    const float rounding = kRounding * at.norm();
    if ((push - along * normal).squaredNorm() <= kOneWall * push.squaredNorm() + rounding * rounding) {
      // One wall pushes: nearly everywhere.
      slip -= state.timeStep * state.boundary.wallVelocity(at);
      state.current[i].setXyz(at - taken({normal, Vec3f::Zero(), along}, slip));
      return;
    }
    thread_local std::vector<Contact> contacts;
    contactsAt(state, at, contacts);
    share(push, contacts);
    // Walls keep the particle in: what goes into one does not slide along another.
    for (const Contact& contact : contacts)
      if (contact.push > 0)
        slip -= std::min(0.0F, (slip - contact.move).dot(contact.normal)) * contact.normal;
    Vec3f back = Vec3f::Zero();
    for (const Contact& contact : contacts) {
      const Vec3f part = taken(contact, slip - contact.move);
      slip -= part;
      back += part;
    }
    state.current[i].setXyz(at - back);
  }

  /// What friction takes back of a way relative to a wall (m): of its part along the wall, up to mu times the
  /// push.
  Vec3f taken(const Contact& contact, Vec3f slip) const {
    slip -= slip.dot(contact.normal) * contact.normal;
    const float length = slip.norm();
    if (contact.push <= 0 || length == 0) return Vec3f::Zero();
    return std::min(1.0F, static_cast<float>(coefficient_) * contact.push / length) * slip;
  }

  double coefficient_ = 0.3;
};

}  // namespace

std::unique_ptr<Effect> makeWallFriction() {
  return std::make_unique<WallFriction>();
}

}  // namespace migiwa
