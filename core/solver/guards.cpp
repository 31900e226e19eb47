// A guard: the pairs of particles in one cell are as many as the square of their number, and so are the time
// and the memory of listing them. Overfull cells are therefore spread first, to the volume that their water
// fills at rest. Positions of the step's start and predicted ones move alike: no particle gains speed by it,
// and two and two move against each other, so that the centre of mass stays where no wall is in the way.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/math.h"
#include "core/solver/state.h"
#include "core/solver/step.h"

namespace migiwa::stages {

namespace {

/// A cell of one support radius is overfull from this many times what it holds at rest on. Fluid that
/// overlaps twice or thrice, and what single steps crowd, is left to the solver.
constexpr double kOverfull = 8;
/// Walls move back together what was spread through them: each round leaves fewer.
constexpr int kMostRounds = 40;

struct Member {
  std::array<std::int64_t, 3> cell;
  std::uint32_t particle;
};

double fewestOfOverfull(const StepState& state) {
  // A cell may hold one layer of a lattice more along each axis, as it lies.
  const double across = static_cast<double>(state.supportRadius) / static_cast<double>(state.spacing) + 1;
  return kOverfull * across * across * across;
}

/// The particles, those of one cell together. The grid's own cells may be much wider.
std::vector<Member> byCells(const StepState& state) {
  std::vector<Member> members;
  members.reserve(state.particles.size());
  const Vec3f origin = state.grid.origin();
  for (const std::uint32_t i : state.grid.order()) {
    const Vec3d place =
        (state.current[i].xyz() - origin).cast<double>() / static_cast<double>(state.supportRadius);
    constexpr double kFarthest = 9e15;  // what a double counts one by one
    if (!(place.cwiseAbs().maxCoeff() < kFarthest)) continue;
    const auto along = [&](int axis) { return static_cast<std::int64_t>(std::floor(place[axis])); };
    members.push_back({{along(0), along(1), along(2)}, i});
  }
  std::stable_sort(members.begin(), members.end(),
                   [](const Member& a, const Member& b) { return a.cell < b.cell; });
  return members;
}

/// Moves a particle by `way`, as far as walls let it.
void displace(StepState& state, std::uint32_t i, const Vec3f& way) {
  Float4& start = state.particles.position[i];
  const Vec3f from = start.xyz();
  Vec3f to = from + way;
  if (!state.collisionWalls.empty()) to = clipMove(state.collisionWalls, from, true, to, state.wallMargin());
  state.boundary.project(to, state.wallMargin());
  start = Float4(to);
  state.current[i] = Float4(Vec3f(state.current[i].xyz() + (to - from)));
}

/// Spreads the members over a ball: pair by pair to opposite sides, the radii such that they fill it evenly.
void spreadCell(StepState& state, std::span<const Member> members) {
  const std::size_t pairs = members.size() / 2;
  const double radius = portable::cbrt(3 * static_cast<double>(members.size()) / (4 * std::numbers::pi)) *
                        static_cast<double>(state.spacing);
  for (std::size_t k = 0; k < pairs; ++k) {
    const std::uint32_t one = members[2 * k].particle, other = members[2 * k + 1].particle;
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(pairs);
    const Vec3f way = static_cast<float>(radius * portable::cbrt(share)) *
                      coincidentDirection(state.particles.id[one], state.particles.id[other]);
    displace(state, one, way);
    displace(state, other, -way);
  }
}

}  // namespace

void spreadOverfullCells(StepState& state) {
  const double fewest = fewestOfOverfull(state);
  for (int round = 0; round < kMostRounds && state.grid.fullestCell() > fewest; ++round) {
    const std::vector<Member> members = byCells(state);
    long spread = 0;
    for (auto begin = members.begin(); begin != members.end();) {
      const auto end = std::find_if(begin, members.end(),
                                    [&](const Member& member) { return member.cell != begin->cell; });
      if (static_cast<double>(end - begin) > fewest) {
        spreadCell(state, {begin, end});
        spread += end - begin;
      }
      begin = end;
    }
    if (spread == 0) return;
    if (round == 0) state.spreadParticles += spread;
    projectAll(state);
    state.grid.build(std::span(state.current).first(state.particles.size()), state.supportRadius, state.pool);
  }
}

}  // namespace migiwa::stages

namespace migiwa {

namespace {

bool tooDense(const IterationError& error) {
  return error.mean > kOverConstrained || error.max > kCrowded;
}

/// The same walls and method, with the particles where the step would leave them.
void prepareTrial(const StepState& state, StepState& trial) {
  trial.thinWalls = state.thinWalls, trial.collisionWalls = state.collisionWalls;
  trial.gammaMethod = state.gammaMethod;
  trial.parameters = state.parameters;
  // Few iterations may be all that the scene allows a step, but they prove nothing.
  constexpr int kIterations = 50;
  trial.parameters.maxIterations = std::max(trial.parameters.maxIterations, kIterations);
  trial.spacing = state.spacing, trial.supportRadius = state.supportRadius;
  trial.lattice = state.lattice;
  trial.particles = state.particles;
  for (std::size_t i = 0; i < trial.particles.size(); ++i)
    trial.particles.position[i] = Float4(state.current[i].xyz());
}

}  // namespace

OverConstrained findOverConstrained(const StepState& state) {
  OverConstrained overConstrained;
  if (!tooDense(state.errors.back())) return overConstrained;
  StepState trial(state.pool, state.boundary);
  prepareTrial(state, trial);
  relax(trial);
  const IterationError& left = trial.errors.back();
  overConstrained.found = tooDense(left);
  overConstrained.mean = left.mean, overConstrained.largest = left.max;
  const auto densest = std::max_element(trial.density.begin(), trial.density.end());
  overConstrained.place =
      trial.particles.position[static_cast<std::size_t>(densest - trial.density.begin())].xyz();
  return overConstrained;
}

namespace {

/// Energy over the share r of a change that is taken back: E(r) = E(0) - r slope + r^2 bend.
struct Parabola {
  double slope = 0, bend = 0;

  /// The smallest share up to 1 that takes `excess`, or most where there is less; 0 where there is none.
  double share(double excess) const {
    if (excess <= 0 || slope <= 0 || bend <= 0) return 0;
    const double under = slope * slope - 4 * bend * excess;
    return std::min(1.0, under > 0 ? 2 * excess / (slope + std::sqrt(under)) : slope / (2 * bend));
  }
  double taken(double share) const { return share * (slope - share * bend); }
};

Parabola operator+(const Parabola& a, const Parabola& b) {
  return {a.slope + b.slope, a.bend + b.bend};
}

/// The share of a change of a velocity that makes it larger than it came, 0 where the velocity is no larger.
/// Both are relative ones; `along` is came . change, `square` that of the change.
float tooMuch(float along, float square) {
  if (!(2 * along + square > 0)) return 0;
  return along >= 0 ? 1 : 1 + 2 * along / square;
}

/// Whether the constraint has moved positions that velocities know nothing of.
bool shiftsPositions(const StepState& state) {
  return state.takesPressure() && state.constrains();
}

/// The velocity that the step's solve has made, effects aside (m/s).
Vec3f solvedVelocity(const StepState& state, std::size_t i) {
  if (shiftsPositions(state)) return state.before.pressed[i].xyz();
  return (state.particles.position[i].xyz() - state.before.position[i].xyz()) / state.timeStep;
}

/// Takes the excess of what has been lifted by moving positions alone: all particles go the same share of the
/// way back. Returns what it took.
double takeFromShift(StepState& state, double excess) {
  const auto shift = [&](std::size_t i) -> Vec3f {
    return state.particles.position[i].xyz() - state.before.position[i].xyz() -
           state.timeStep * state.before.pressed[i].xyz();
  };
  const auto lift = [&] {
    return parallelSum(state.pool, state.particles.size(),
                       [&](std::size_t i) { return -static_cast<double>(state.gravity.dot(shift(i))); });
  };
  const double lifted = lift();
  if (lifted <= 0) return 0;
  const auto share = static_cast<float>(std::min(1.0, excess / lifted));
  parallelEach(state.pool, state.particles.size(), [&](std::size_t i) {
    Vec3f place = state.particles.position[i].xyz() - share * shift(i);
    state.boundary.project(place, state.wallMargin());
    state.current[i].setXyz(place);
  });
  state.particles.position.swap(state.before.position);
  stages::updatePositions(state);
  return lifted - lift();
}

/// The changes of velocity that a step's solve has made, and what is taken back of them.
class Taking {
 public:
  explicit Taking(StepState& state) : state_(state), half_(0.5F * state.timeStep * state.gravity) {
    const std::size_t n = state.particles.size();
    change_.resize(n), back_.resize(n), degree_.resize(n), group_.resize(n), gains_.resize(n);
    forAll([&](std::size_t i) { change_[i] = Float4(Vec3f(solvedVelocity(state_, i) - came(i))); });
    made_ = change_;
    findGroups();
  }

  /// Takes what pairs and walls have gained of up to `excess`; returns what it took.
  double takeFromPairs(double excess) {
    forAll([&](std::size_t i) { gains_[i] = ofGroup_[group_[i]] > 0 && neighbourhoodGains(i) ? 1 : 0; });
    forAll([&](std::size_t i) {
      std::uint32_t count = 0;
      for (const std::uint32_t j : state_.neighbours.of(i))
        if (shareOf(i, j) > 0) ++count;
      degree_[i] = count;
    });
    return take(excess, [&](std::size_t i) {
      Vec3f back = Vec3f::Zero();
      float wallWork = 0;
      for (const std::uint32_t j : state_.neighbours.of(i)) {
        // One over the larger number of pairs: the changes come together and none passes its neighbours'.
        const float share = shareOf(i, j) / static_cast<float>(1 + std::max(degree_[i], degree_[j]));
        if (share > 0) back += share * Vec3f(change_[i].xyz() - change_[j].xyz());
      }
      if (Wall wall; atWall(i, wall) && wall.share > 0) {
        const float push =
            wall.share / static_cast<float>(1 + degree_[i]) * change_[i].xyz().dot(wall.normal);
        back += push * wall.normal;
        wallWork = push * wall.velocity;
      }
      back_[i] = Float4(back, wallWork);
    });
  }

  /// Takes of all changes in the groups that gained. Of a group at moving walls it is unknown what they gave.
  double takeFromGroups(double excess) {
    if (state_.boundary.moves())
      for (const WallSlot& slot : state_.wallSlots) ofGroup_[group_[slot.particle]] = 0;
    return take(excess, [&](std::size_t i) {
      back_[i] = ofGroup_[group_[i]] > 0 ? Float4(change_[i].xyz()) : Float4(Vec3f(Vec3f::Zero()));
    });
  }

  /// How many particles' velocities change.
  std::size_t changed() const {
    return parallelReduce(
        state_.pool, change_.size(), std::size_t{0},
        [&](std::size_t begin, std::size_t end) {
          std::size_t count = 0;
          for (std::size_t i = begin; i < end; ++i)
            if (change_[i].xyz() != made_[i].xyz()) ++count;
          return count;
        },
        [](std::size_t a, std::size_t b) { return a + b; });
  }
  /// Writes the velocities, as they are before effects.
  void finish() {
    forAll([&](std::size_t i) { state_.particles.velocity[i].setXyz(came(i) + change_[i].xyz()); });
  }

 private:
  struct Wall {
    Vec3f normal;
    float velocity = 0;  ///< of the wall along the normal (m/s)
    float share = 0;
  };

  template <class One>
  void forAll(const One& one) {
    parallelFor(state_.pool, change_.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) one(i);
    });
  }
  Vec3f came(std::size_t i) const { return state_.before.velocity[i].xyz(); }

  /// Numbers the groups of particles that neighbours connect, and adds up what each has gained.
  void findGroups() {
    std::iota(group_.begin(), group_.end(), 0U);
    const auto root = [&](std::uint32_t i) {
      while (group_[i] != i) i = group_[i] = group_[group_[i]];
      return i;
    };
    for (std::uint32_t i = 0; i < group_.size(); ++i) {
      for (const std::uint32_t j : state_.neighbours.of(i)) {
        const std::uint32_t a = root(i), b = root(j);
        group_[std::max(a, b)] = std::min(a, b);
      }
    }
    ofGroup_.assign(group_.size(), 0);
    for (std::uint32_t i = 0; i < group_.size(); ++i) {
      group_[i] = root(i);
      // Where the particle ends counts, too. What moving walls gave is in it and cannot be told apart.
      const Vec3d change = change_[i].xyz().cast<double>();
      ofGroup_[group_[i]] += change.dot(Vec3f(came(i) - half_).cast<double>()) + 0.5 * change.squaredNorm();
    }
  }

  /// Of a pair: (came . change, |change|^2), both relative.
  std::pair<float, float> gainOf(std::size_t i, std::size_t j) const {
    const Vec3f change = change_[i].xyz() - change_[j].xyz();
    return {Vec3f(came(i) - came(j)).dot(change), change.squaredNorm()};
  }
  float shareOf(std::size_t i, std::size_t j) const {
    if (gains_[i] == 0 && gains_[j] == 0) return 0;
    const auto [along, square] = gainOf(i, j);
    return tooMuch(along, square);
  }
  bool atWall(std::size_t i, Wall& wall) const {
    const std::uint32_t slot = state_.wallSlot.empty() ? FluidState::kNoWall : state_.wallSlot[i];
    if (slot == FluidState::kNoWall || gains_[i] == 0) return false;
    const Vec3f gradient = state_.wallSlots[slot].sample.pairGradient;
    const float length = gradient.norm();
    if (!(length > 0)) return false;
    wall.normal = gradient / length;
    wall.velocity = state_.boundary.wallVelocity(state_.particles.position[i].xyz()).dot(wall.normal);
    const float change = change_[i].xyz().dot(wall.normal);
    wall.share = tooMuch((came(i).dot(wall.normal) - wall.velocity) * change, change * change);
    return true;
  }
  /// Whether a particle and its neighbours move faster among each other, or off a wall, than they came.
  bool neighbourhoodGains(std::size_t i) {
    float gained = 0;
    for (const std::uint32_t j : state_.neighbours.of(i)) {
      const auto [along, square] = gainOf(i, j);
      gained += 2 * along + square;
    }
    if (gained > 0) return true;
    gains_[i] = 1;
    Wall wall;
    return atWall(i, wall) && wall.share > 0;
  }

  /// Fills in back_ for each particle by `fill` and takes as much of that as `excess` asks for.
  template <class Fill>
  double take(double excess, const Fill& fill) {
    const std::pair<Parabola, double> sums = parallelReduce(
        state_.pool, change_.size(), std::pair<Parabola, double>{},
        [&](std::size_t begin, std::size_t end) {
          std::pair<Parabola, double> part;
          for (std::size_t i = begin; i < end; ++i) {
            fill(i);
            const Vec3d back = back_[i].xyz().cast<double>();
            const auto work = static_cast<double>(back_[i].w);
            part.first.slope += back.dot(Vec3f(came(i) + change_[i].xyz() + half_).cast<double>()) - work;
            part.first.bend += 0.5 * back.squaredNorm();
            part.second += work;
          }
          return part;
        },
        [](const auto& a, const auto& b) { return std::pair(a.first + b.first, a.second + b.second); });
    const double share = sums.first.share(excess);
    if (share <= 0) return 0;
    forAll([&](std::size_t i) {
      change_[i] = Float4(Vec3f(change_[i].xyz() - static_cast<float>(share) * back_[i].xyz()));
    });
    state_.wallWork.add(-share * sums.second * static_cast<double>(state_.timeStep));
    return sums.first.taken(share);
  }

  StepState& state_;
  Vec3f half_;                         ///< what gravity adds in half a step (m/s)
  std::vector<Float4> change_, made_;  ///< as it is now, and as the solve has made it (m/s)
  std::vector<Float4> back_;  ///< to be taken of it (m/s); w: of that, times the velocity of walls (m^2/s^2)
  std::vector<std::uint32_t> degree_;  ///< pairs that gained
  std::vector<std::uint32_t> group_;   ///< its least member
  std::vector<std::uint8_t> gains_;    ///< whether its neighbourhood does
  std::vector<double> ofGroup_;        ///< what it gained (m^2/s^2)
};

}  // namespace

HeldEnergy holdEnergy(StepState& state, EffectPipeline& effects, double excess) {
  HeldEnergy held;
  if (excess <= 0) return held;
  constexpr double kAll = 1 - 1e-6;
  if (shiftsPositions(state)) {
    held.taken = takeFromShift(state, excess);
    if (held.taken > 0) held.particles = state.particles.size();
    if (held.taken >= kAll * excess) return held;
  }
  // Each pass takes what pairs can give at once; a front that lies deep in the fluid needs several.
  constexpr int kMostPasses = 32;
  Taking taking(state);
  for (int pass = 0; pass < kMostPasses && held.taken < kAll * excess; ++pass) {
    const double taken = taking.takeFromPairs(excess - held.taken);
    held.taken += taken;
    if (taken <= 1e-3 * held.taken) break;
  }
  if (held.taken < kAll * excess) held.taken += taking.takeFromGroups(excess - held.taken);
  const std::size_t changed = taking.changed();
  if (changed == 0) return held;
  held.particles = std::max(held.particles, changed);
  taking.finish();
  state.effectWork -= std::exchange(state.velocityEffectWork, 0);
  effects.changeVelocities(state, {});
  return held;
}

}  // namespace migiwa
