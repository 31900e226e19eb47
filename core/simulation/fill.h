// Particles that a simulation starts with, those that emitters add, and those that leave.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/scene/drain.h"
#include "core/scene/scene.h"
#include "core/simulation/state.h"
#include "core/simulation/statistics.h"
#include "core/solver/energy.h"
#include "core/solver/state.h"
#include "core/walls/boundary.h"

namespace migiwa {

// The particles that a scene starts with.

/// Fills the union of the sources, each with its lattice, trimmed at the solids and at the particles of
/// earlier sources. What that leaves out or adds is a warning, with its share; so is fluid of three layers or
/// fewer.
void fillScene(Scene& scene, const Boundary& boundary, Particles& particles);

// What the emitters of a scene give while it runs. Layer k of an emitter leaves the mouth at
// start + k * thickness / speed, whatever the substeps, so two integers say how far an emitter is.

/// What an emitter has given so far.
struct EmitterState {
  std::int64_t layers = 0;
  std::int64_t particles = 0;
};

class Emission {
 public:
  /// Keeps no reference to the scene. Warns of mouths that are within walls. Throws InputError where a layer
  /// has no room in memory. `most`: particles that all of the simulation may have.
  Emission(Scene& scene, const Boundary& boundary, double most = kLargestCount);

  bool empty() const { return mouths_.empty(); }
  /// Adds the layers that have left by `time` (s), where they are by then, and counts them. Places of a mouth
  /// that have no room give nothing; those at a wall that the fluid comes out of give it in front of it. Ids
  /// go on from the number of particles that there ever were, so that none comes twice. An emitter that
  /// reaches its limit, or that of the simulation or its memory, gives nothing more, and is noted as trouble.
  void emit(double time, StepState& state, RunStatistics& statistics);
  /// The largest speed (m/s) at a mouth that is open between `from` and `to` (s).
  double largestSpeed(double from, double to) const;

  /// For a save: how far the emitters are.
  void visit(StateVisitor& visitor);

 private:
  struct Mouth {
    Emitter emitter;
    MouthLayer layer;
    Vec3d ahead;      ///< unit
    Vec3d velocity;   ///< (m/s)
    double interval;  ///< from layer to layer (s)
  };
  /// Puts the places where particles begin now into open_.
  void openPlaces(const Mouth& mouth, const Boundary& boundary, double spacing);
  void addLayer(const Mouth& mouth, double age, std::int64_t firstId, StepState& state) const;

  std::vector<Mouth> mouths_;
  std::vector<EmitterState> given_;
  std::vector<Vec3d> open_;  ///< of the layer that leaves (m)
  double most_;
};

// What leaves the fluid while it is simulated: through drains, and out of the scene's bounds.

class Outflow {
 public:
  /// Keeps no reference to the scene. Warns of drains that no fluid can come into.
  Outflow(Scene& scene, const Boundary& boundary);

  /// Whether a drain is open at `time` (s).
  bool anyOpen(double time) const;
  /// Before a step, removes the particles that are in a drain that is open at `time` (s), the first of
  /// several, and those that are out of `domain`, unless that is empty. The others keep their order and what
  /// is known of them. Counts them, with their energy, and returns the sums of it; `centre` as HealthLimits
  /// has it.
  EnergySums remove(double time, const Bounds& domain, const Vec3f& centre, StepState& state,
                    RunStatistics& statistics) const;

 private:
  struct Outlet {
    Drain drain;
    DrainRegion region;
  };
  /// Number of the drain that takes p, counted from 0; kStays or kLeaves.
  int fateOf(const Vec3d& p, double time, const Bounds& domain) const;

  std::vector<Outlet> outlets_;
};

// Other walls in the place of those that a simulation has: for as long as it is not certain that they stay.

class WallExchange {
 public:
  explicit WallExchange(Boundary& place) : place_(place) {}
  /// Puts the old walls back, unless the new ones are to be kept.
  ~WallExchange() {
    if (put_) std::swap(place_, other_);
  }
  WallExchange(const WallExchange&) = delete;
  WallExchange& operator=(const WallExchange&) = delete;

  /// Once. What refers to the old surfaces goes on doing so: they last as long as this exchange.
  void put(Boundary walls) {
    other_ = std::move(walls);
    std::swap(place_, other_);
    put_ = true;
  }
  void keep() { put_ = false; }

 private:
  static_assert(std::is_nothrow_move_constructible_v<Boundary> &&
                std::is_nothrow_move_assignable_v<Boundary>);

  Boundary& place_;
  Boundary other_;
  bool put_ = false;
};

}  // namespace migiwa
