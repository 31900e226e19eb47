// A scene in motion.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/parallel.h"
#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/statistics.h"
#include "core/solver/effect.h"
#include "core/solver/parameters.h"

namespace migiwa {

// What may change between two steps of a running simulation.

struct Settings {
  SolverParameters solver;
  BoundaryParameters boundary;
  std::vector<NamedEffect> effects;
};

/// Throws InputError where these settings of the scene file `scene` name a method for gamma that is only
/// there to compare with: no simulation can use it in every step.
void requireSteppable(const BoundaryParameters& boundary, const std::filesystem::path& scene);

/// The arrays of a FrameView that Simulation::detach() can hand over.
enum class FrameArray { positions, velocities, density, gamma, lambda, pressure, ids };

// A scene in motion. Owns the particles and the solver; knows nothing of windows, files and pictures.

class StateVisitor;

class Simulation {
 public:
  /// Fills the sources and prepares the walls. `threads` 0 takes what the machine has. Without guards
  /// hard cases may fall apart: for comparison only.
  explicit Simulation(Scene scene, int threads = 0, Guards guards = Guards::on);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// One frame: `time_step` of simulated time, in as many substeps as the scene and the CFL rule ask for.
  void advanceFrame();
  /// The number of the frame that a time falls on.
  long frameAt(double time) const;
  long frame() const;
  double time() const;

  Settings settings() const;
  /// Takes effect with the next frame. Changing the kernel or the support ratio keeps positions and
  /// velocities. Throws InputError where walls cannot be handled so, or memory is short; everything is then
  /// as if nothing had been asked.
  void apply(const Settings& settings);

  const Scene& scene() const;
  FrameView view() const;
  /// The same for a picture: with the walls where some of them move. Their drawing is made when it is first
  /// asked for in a frame; a run without pictures makes none.
  FrameView drawnView() const;
  /// Hands over the memory that view() shows of an array, and goes on in a copy. For who holds a span of it
  /// beyond the next step or the end of the simulation: it stays valid as long as what is returned here, with
  /// the values of now.
  std::shared_ptr<const void> detach(FrameArray array);
  /// h grad gamma for the density kernel at each particle, in the order of view(); 0 where no wall is in
  /// reach.
  std::vector<Vec3f> gammaGradients() const;
  /// From the next frame on, view() has pressures, or none; state and hash are the same either way. A scene
  /// that is coloured by pressure has them from the start, and one that has a gauge for it always.
  void watchPressure(bool on);
  /// Hash of ids, positions and velocities; the same for any number of threads.
  std::uint64_t stateHash() const;
  const RunStatistics& statistics() const;
  int threads() const;
  /// True after a non-finite state, a lost particle or a squeeze; advanceFrame then does nothing more.
  bool stopped() const;
  /// Whether the state is one to go on from: also after a step that was refused, for that leaves the state of
  /// before; not after a lost particle.
  bool goodState() const;
  /// For a save: all that the future depends on, and what the report and a picture say of the past. Reading
  /// takes a simulation of the same scene; throws StateError when what is read does not fit, and is then of
  /// no further use.
  void visitState(StateVisitor& visitor);
  /// Walls for drawing, where they are now.
  WallDrawing walls() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace migiwa
