// A box tank full of particles at their resting distance, each pushed a little out of its place: the state
// that the passes of the solver are measured and compared on.
#pragma once

#include <cmath>
#include <memory>

#include "core/solver/state.h"
#include "core/solver/step.h"
#include "core/walls/shapes.h"

namespace migiwa::testing {

class DenseTank {
 public:
  static constexpr float kSpacing = 0.05F;

  DenseTank(std::size_t atLeast, int threads)
      : pool_(threads), side_(static_cast<int>(std::ceil(std::cbrt(static_cast<double>(atLeast))))) {
    const double size = static_cast<double>(side_) * static_cast<double>(kSpacing);
    boundary_ = Boundary({std::make_shared<Box>(Vec3d::Zero(), Vec3d(size, 1.3 * size, size),
                                                Box::Fluid::inside, Rotation{})});
    state_ = std::make_unique<StepState>(pool_, boundary_);
    StepState& state = *state_;
    state.spacing = kSpacing;
    state.parameters.takeVelocities(VelocityStep::positions);
    state.supportRadius = 2 * kSpacing;
    state.lattice = restingLattice(state.parameters.kernel, state.parameters.supportRatio);
    state.gravity = Vec3f(0, -9.81F, 0);
    state.timeStep = 0.005F;
    gamma_ = makeGammaMethod(0, {boundary_, state.parameters.kernel, state.supportRadius});
    state.gammaMethod = gamma_.method.get();
    fill();
  }

  StepState& state() { return *state_; }

  /// Positions as predicted, neighbours and gamma: ready for the passes of an iteration.
  void prepare() { prepareFields(*state_); }

 private:
  void fill() {
    Particles& particles = state_->particles;
    std::uint32_t bits = 1;
    const auto jitter = [&bits] {
      bits = bits * 1664525U + 1013904223U;
      return 0.1F * kSpacing * (static_cast<float>(bits >> 8) / 16777216.0F - 0.5F);
    };
    const auto at = [](int cell) { return (static_cast<float>(cell) + 0.5F) * kSpacing; };
    for (int z = 0; z < side_; ++z) {
      for (int y = 0; y < side_; ++y) {
        for (int x = 0; x < side_; ++x) {
          const float dx = jitter(), dy = jitter(), dz = jitter();
          Vec3f p(at(x) + dx, at(y) + dy, at(z) + dz);
          boundary_.project(p, state_->wallMargin());
          particles.position.emplace_back(p);
          particles.id.push_back(static_cast<std::uint32_t>(particles.id.size()));
        }
      }
    }
    particles.velocity.assign(particles.position.size(), Float4());
  }

  ThreadPool pool_;
  int side_;
  Boundary boundary_;
  PickedGamma gamma_;
  std::unique_ptr<StepState> state_;
};

}  // namespace migiwa::testing
