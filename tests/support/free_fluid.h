// Particles without walls and gravity, with their neighbours: what an effect by itself is tried on.
#pragma once

#include <functional>

#include "core/solver/step.h"
#include "tests/support/test_effects.h"

namespace migiwa::testing {

/// A cubic lattice of `side` particles an axis about the origin, 0.05 m apart, each pushed up to `jitter`
/// spacings out of its place.
inline std::vector<Vec3f> latticePlaces(int side, float jitter) {
  std::uint32_t bits = 7;
  const auto random = [&bits] {
    bits = bits * 1664525U + 1013904223U;
    return 2 * static_cast<float>(bits >> 8) / 16777216.0F - 1;
  };
  const float middle = 0.5F * static_cast<float>(side - 1);
  const auto at = [&](int cell) { return 0.05F * (static_cast<float>(cell) - middle + jitter * random()); };
  std::vector<Vec3f> places;
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const float px = at(x), py = at(y), pz = at(z);
        places.emplace_back(px, py, pz);
      }
    }
  }
  return places;
}

class FreeFluid {
 public:
  /// Particles 0.05 m apart.
  FreeFluid(const std::vector<Vec3f>& places, const std::function<Vec3f(const Vec3f&)>& velocityAt)
      : pool_(1), state_(pool_, boundary_) {
    state_.parameters.takeVelocities(VelocityStep::positions);
    state_.spacing = 0.05F;
    state_.supportRadius = 2 * state_.spacing;
    state_.lattice = restingLattice(state_.parameters.kernel, state_.parameters.supportRatio);
    state_.timeStep = 0.005F;
    Particles& particles = state_.particles;
    for (const Vec3f& place : places) {
      particles.position.emplace_back(place);
      particles.velocity.emplace_back(velocityAt(place));
      particles.id.push_back(static_cast<std::uint32_t>(particles.id.size()));
    }
    prepareFields(state_);
  }

  StepState& state() { return state_; }

  /// Lets the effects act on the velocities once; particles stay where they are.
  void changeVelocities(const std::string& effects) {
    EffectPipeline pipeline(effectsOf(effects));
    pipeline.changeVelocities(state_);
  }

 private:
  ThreadPool pool_;
  Boundary boundary_;
  StepState state_;
};

}  // namespace migiwa::testing
