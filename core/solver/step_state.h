// Everything that the stages of a step read and write. Per-particle arrays share one order, along the search
// grid; `id` tells particles apart across steps. Lengths inside the solver are metres; densities are
// rho/rho0; gradients are per support radius, so that nothing over- or underflows with the size of the scene.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/stage_times.h"
#include "core/boundary/boundary.h"
#include "core/boundary/gamma_method.h"
#include "core/solver/energy.h"
#include "core/solver/iteration_error.h"
#include "core/solver/parameters.h"
#include "core/solver/pressure.h"
#include "core/sph/neighbour_lists.h"
#include "core/sph/resting_lattice.h"

namespace migiwa {

/// What lasts from step to step.
struct Particles {
  std::vector<Float4> position;  ///< (m); w: a clearance to walls (m) that it has at least, 0: not known
  std::vector<Float4> velocity;  ///< (m/s)
  std::vector<std::uint32_t> id;
  std::size_t size() const { return id.size(); }
};

/// A particle near a wall: where gamma was last evaluated, and what it was there.
struct WallSlot {
  std::uint32_t particle;
  Float4 at;           ///< point of evaluation (m)
  GammaSample sample;  ///< at that point
};

/// Without the room for growth that std::vector would add: at millions of particles it is felt.
template <class T>
void resizeTight(std::vector<T>& values, std::size_t size) {
  values.reserve(size);
  values.resize(size);
}

/// Of the start of a step; velocities with gravity's gain.
struct BeforeStep {
  std::vector<Float4> position, velocity;
};

/// A push by a wall that was kept from giving speed: where its particle began the step until then.
struct WithheldJump {
  std::uint32_t id;
  Float4 began;
};

struct StepState {
  StepState(ThreadPool& threadPool, const Boundary& walls) : pool(threadPool), boundary(walls) {}

  ThreadPool& pool;
  const Boundary& boundary;
  std::vector<const Surface*> thinWalls;  ///< thinner than the support radius
  std::vector<const Surface*>
      barringWalls;  ///< that no move may pass through: thin ones, and those that move
  const GammaMethod* gammaMethod = nullptr;  ///< null: no correction
  SolverParameters parameters;
  Vec3f gravity = Vec3f::Zero();  ///< (m/s^2)
  float spacing = 0;              ///< (m)
  float supportRadius = 0;        ///< (m)
  RestingLattice lattice{};
  float timeStep = 0;  ///< of this substep (s)

  Particles particles;

  // Of the current step.
  // Those that passes over neighbours read end with the ghost that fills up the neighbour lists.
  std::vector<Float4> current;   ///< predicted position (m), then that of the iteration
  std::vector<Float4> previous;  ///< the same an iteration earlier (m); free outside the iterations
  std::vector<Float4> paired;    ///< of the iteration, with the factor that Eq. 10 sums in w; free outside
  BeforeStep before;             ///< to take back the step, or energy that it made; empty without guards
  std::vector<std::uint32_t> spareIds;  ///< to sort the particles through
  CellGrid grid;
  NeighbourLists neighbours;
  // These last from step to step: gamma is evaluated anew only where a particle has moved.
  std::vector<WallSlot> wallSlots;
  std::vector<std::uint32_t> wallSlot;  ///< of each particle, or kNoWall
  std::vector<float> gamma;
  std::vector<float> density;  ///< rho/rho0
  std::vector<float> lambda;   ///< Eq. 11 over the squared support radius (1)
  std::vector<IterationError> errors;
  int iterations = 0;

  // Guards that acted in this step.
  long gammaFloored = 0;
  std::vector<WithheldJump> wallJumps;
  long spreadParticles = 0;                         ///< off heaps, see stages::spreadHeaps
  mutable std::atomic<bool> metCoincident = false;  ///< a pass over pairs met one on one point

  // Energy that the step was given, see core/solver/energy.h.
  WallWork wallWork;
  double effectWork = 0;          ///< by the effects (m^2/s^2); friction at moving walls included
  double velocityEffectWork = 0;  ///< the part of those on velocities (m^2/s^2)

  PressureSum pressure;

  StageTimes times;

  static constexpr std::uint32_t kNoWall = std::numeric_limits<std::uint32_t>::max();
  /// Whether the walls' part of the density is added, rather than divided by gamma.
  bool addsWallDensity() const { return gammaMethod != nullptr && gammaMethod->form() == WallDensity::added; }
  /// What the wall's push on particle i is over the pair gradient of its sample, but for the sign: lambda
  /// times the constraint's derivative with respect to gamma.
  float wallPush(std::size_t i) const {
    return addsWallDensity() ? lambda[i] : lambda[i] * density[i] / gamma[i];
  }
  /// Centres stay this far inside the fluid side (m).
  float wallMargin() const { return 0.5F * spacing; }
};

}  // namespace migiwa
