// What the emitters of a scene give while it runs. Layer k of an emitter leaves the mouth at
// start + k * thickness / speed, whatever the substeps, so two integers say how far an emitter is.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/particle_limit.h"
#include "core/scene/scene.h"
#include "core/simulation/state_visitor.h"
#include "core/simulation/statistics.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// What an emitter has given so far.
struct EmitterState {
  std::int64_t layers = 0;
  std::int64_t particles = 0;
};

class Emission {
 public:
  /// Keeps no reference to the scene. Warns of mouths within walls. Throws InputError where a layer has no
  /// room in memory. `most`: particles that all of the simulation may have.
  Emission(Scene& scene, const Boundary& boundary, double most = kLargestCount);

  bool empty() const { return mouths_.empty(); }
  /// Adds the layers that have left by `time` (s), where they are by then. Ids go on from the number of
  /// particles. An emitter that reaches its limit, or that of the simulation or its memory, gives nothing
  /// more, and is noted as trouble.
  void emit(double time, StepState& state, RunStatistics& statistics);
  /// The largest speed (m/s) at a mouth that is open between `from` and `to` (s).
  double largestSpeed(double from, double to) const;

  /// For a save: how far the emitters are.
  void visit(StateVisitor& visitor);

 private:
  struct Mouth {
    Emitter emitter;
    MouthLayer layer;
    Vec3d velocity;   ///< (m/s)
    double interval;  ///< from layer to layer (s)
  };
  static void addLayer(const Mouth& mouth, double age, StepState& state);

  std::vector<Mouth> mouths_;
  std::vector<EmitterState> given_;
  double most_;
};

}  // namespace migiwa
