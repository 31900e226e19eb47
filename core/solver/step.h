// The position based fluid step ([FM] section 4, Macklin & Mueller 2013): what runs it, and its parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/solver/effect.h"
#include "core/solver/state.h"

namespace migiwa {

// What the effects of a scene add to a step: a list for each place where effects act, and the scratch buffers
// that they share. A scene without effects has empty lists and no buffers.

class EffectPipeline {
 public:
  EffectPipeline() = default;
  explicit EffectPipeline(const std::vector<NamedEffect>& effects);

  /// Called with an effect's name after it has acted; empty: nothing is called.
  using Watch = std::function<void(std::string_view)>;

  // Each effect's time is booked under its name.
  void changePrediction(StepState& state, const Watch& watch = {});
  void changePositions(StepState& state, float weight, const Watch& watch = {});
  /// False where it leaves a velocity that is not finite, or that is too large for its square to be.
  bool changeVelocities(StepState& state, const Watch& watch = {});

  /// The longest step (s) over which all of them are stable.
  double longestStep(const StepState& state) const;

 private:
  std::vector<NamedEffect> prediction_, iteration_, velocity_;
  std::vector<EffectBuffer> buffers_;
};

// Fluid that walls leave less room than it needs: no positions of the particles are free of density errors,
// and a solve that is given time would turn the errors that it cannot undo into ever more speed.

/// Density error of a start, or of what a step leaves, above which fluid is on top of fluid. A lattice
/// between walls reads some percent.
inline constexpr double kCrowded = 0.5;

/// Mean density error that fluid with room enough is never left with. Uniform fluid has it when its room is a
/// tenth too small; what a lattice between walls reads by itself is half of that in the layers at the walls,
/// and less in the mean.
inline constexpr double kOverConstrained = 0.1;

/// What is left of the density errors once nothing is asked of the fluid but room.
struct OverConstrained {
  bool found = false;
  double mean = 0;              ///< density error
  double largest = 0;           ///< density error
  Vec3f place = Vec3f::Zero();  ///< where it is (m)
};

/// Whether the places where a step ends, `state.current`, leave density errors for want of room: those above
/// a bound that stay above it when the density is solved on positions alone, at length and with no speed or
/// gravity to work against. Looks at `state.errors` alone where these are within the bounds.
OverConstrained findOverConstrained(const StepState& state);

// The step.

/// Why a step was refused, if it was.
struct StepRefusal {
  bool notFinite = false;           ///< a particle would end at a place or with a velocity that is not finite
  OverConstrained overConstrained;  ///< walls leave the fluid no room
  bool any() const { return notFinite || overConstrained.found; }
};

/// Advances the state by `state.timeStep`, with what the effects add. Positions and velocities of a refused
/// step are those of before (velocities but for rounding, gravity's gain having been added and taken back),
/// in another order.
StepRefusal advanceStep(StepState& state, EffectPipeline& effects);

/// The longest step (s) over which the solver and all effects are stable.
double longestStep(const StepState& state, const EffectPipeline& effects);

/// What of a refused step was not finite first.
struct StepFault {
  std::string stage;                      ///< the one that left it so, or the effect
  std::uint32_t particle = 0;             ///< id of one of them
  long particles = 0;                     ///< how many there are
  std::vector<std::uint32_t> neighbours;  ///< ids of that particle's
};
/// Makes a refused step once more and looks through the state after every stage.
StepFault findFault(StepState& state, EffectPipeline& effects);

/// For fluid that starts inside walls: projects it out and solves the density on the positions alone, so that
/// the push does not become speed. Returns how many particles were inside; 0: nothing was done.
long stabilise(StepState& state);

/// Solves the density on the positions alone, for fluid that starts on top of fluid: what pushes particles
/// apart does not become speed.
void relax(StepState& state);

/// Neighbours, gamma, density and lambda of the positions as they are, for a picture of the start.
void prepareFields(StepState& state);

// Walls thinner than the support radius, METHOD: gamma counts only the fluid visible from a particle, so what
// lies behind such a wall is no neighbour, and no particle may pass through it in one move.

/// The walls of a boundary that are thinner than the support radius (m).
WallIndex thinWalls(const Boundary& boundary, float supportRadius);
/// Those, solids of which a part is so thin, and the solids that move: they may come from one side of a
/// particle to the other in one step.
WallIndex collisionWalls(const Boundary& boundary, float supportRadius);

/// Where a move ends that thin walls bar: `margin` (m) before the wall that it meets, where it would have
/// gone along the wall. A move that starts inside of a wall is left as it is. `from` is a place of the start
/// of the step if `stepBegan`: what counts is the way relative to the wall, which has moved since.
Vec3f clipMove(const WallIndex& walls, const Vec3f& from, bool stepBegan, const Vec3f& to, float margin);

// Energy that a step made from nothing. A projection onto a convex set that holds the start never lengthens
// the way, so that undoing density errors takes kinetic energy. The density is not convex in the positions,
// and particles that hit each other at half a spacing a step are pushed out of one another by the sum of what
// each neighbour alone would ask for: further than they came, and by the next step with that speed.
//
// Pushes act between neighbours, so the particles that are connected by neighbours are a group of its own:
// what a group gained is taken from that group. Within it a pair has gained whose members part faster than
// they came, and where it lies among others that gained, it gives back of what the solve changed of its
// relative velocity as much as is too much. One takes what the other gives: momentum stays, of all and of
// each group. Walls that push a particle off faster than it came take back their own push, along their
// normal.

/// What holdEnergy() has done.
struct HeldEnergy {
  double taken = 0;           ///< (m^2/s^2), a sum over the particles
  std::size_t particles = 0;  ///< whose velocity or place it has changed
};

// With a projection, what moves positions alone lifts particles that get no slower by it. That is taken back
// first: all go a share of the way back.

/// Takes `excess` (m^2/s^2, a sum over the particles) of a finished step's energy back, or as much of it as
/// there is, where it was gained. Of positions only the shift of a projection changes; else they stay, and so
/// what the solve has undone of density errors. What moving walls gave less by it is taken off their work,
/// and effects on velocities act anew. The neighbours are those that the step was solved with.
HeldEnergy holdEnergy(StepState& state, EffectPipeline& effects, double excess);

}  // namespace migiwa

// The stages of a step, in the order in which they run. Each gathers: it writes only what belongs to its own
// particle.
namespace migiwa::stages {

/// v += g dt, then x* = x + v dt, kept on the fluid side of the walls.
void predict(StepState& state);
/// Moves apart what lies in overfull cells, see guards.cpp; the grid is that of the predicted
/// positions, and is made anew.
void spreadOverfullCells(StepState& state);
/// Sorts the particles along the grid and lists the neighbours of the predicted positions.
void searchNeighbours(StepState& state);
/// Takes those across a thin wall out of the neighbour lists.
void separateNeighbours(StepState& state);
/// gamma and its gradient ([FM] Eq. 6) for the particles near walls.
void evaluateGamma(StepState& state);
/// gamma at the moved positions: linearised, or evaluated anew where a particle has moved too far.
void refreshGamma(StepState& state);
/// Density ([FM] Eq. 5), constraint (Eq. 9) and lambda (Eqs. 11 to 13). Returns the density error.
IterationError computeLambda(StepState& state);
/// Moves the predicted positions by [FM] Eq. 10 in the form that the parameters name, `weight` times as far
/// from the positions of the previous iteration (1: Eq. 10 itself).
void movePositions(StepState& state, float weight = 1);
/// Puts the particles near walls back on the fluid side.
void projectNearWalls(StepState& state);
/// The same for every particle: one that was far from the walls may have crossed one in a single move.
void projectAll(StepState& state);
/// What walls that push by depth add to the prediction; see penalty.cpp.
void pushOutOfSoftWalls(StepState& state);
/// v = (x* - x) / dt.
void takeVelocities(StepState& state);
/// x* = x + v dt.
void moveAlong(StepState& state);
/// x = x*, velocities stay. What was before is kept in state.before.
void updatePositions(StepState& state);
/// v = (x* - x) / dt, x = x*. What was before is kept in state.before if `keep`.
void updateVelocities(StepState& state, bool keep);
/// Takes over the solved positions and leaves the velocities alone.
void acceptPositions(StepState& state);

}  // namespace migiwa::stages
