// The state that the stages of a step share: what lasts, the scratch buffers and the record of a step.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/solver/energy.h"
#include "core/solver/parameters.h"
#include "core/sph/kernels.h"
#include "core/sph/neighbours.h"
#include "core/walls/boundary.h"

namespace migiwa {

/// Density error max(rho/rho0 - 1, 0) over the particles, after an iteration.
struct IterationError {
  double mean = 0;
  double max = 0;
  double meanSquare = 0;  ///< mean of the squares
};

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

/// Without the room for growth that std::vector would add: at millions of particles the memory counts.
template <class T>
void resizeTight(std::vector<T>& values, std::size_t size) {
  values.reserve(size);
  values.resize(size);
}

/// Of the start of a step; velocities with gravity's gain.
struct BeforeStep {
  std::vector<Float4> position, velocity;
  std::vector<Float4> pressed;  ///< of a projection: what the pressure has made of the velocities
};

/// A push by a wall that gives no speed: where its particle began the step until then.
struct SuppressedPush {
  std::uint32_t id;
  Float4 began;
};

/// The inverse of the moment matrix of a particle's neighbours, -(m/rho0) sum_j grad W_ij (x_i - x_j)^T: it
/// makes gradients by differences exact for what is linear in space.
struct InverseMoment {
  Vec3f diagonal = Vec3f::Zero();  ///< xx, yy, zz
  Vec3f rest = Vec3f::Zero();      ///< xy, xz, yz
  bool sound = false;              ///< whether there is one

  InverseMoment() = default;
  /// Of the matrix with that diagonal (xx, yy, zz) and that rest (xy, xz, yz), by its cofactors.
  InverseMoment(const Vec3f& d, const Vec3f& r) {
    constexpr float kSound = 0.02F;  // determinant below which the inverse is not to be trusted
    const Vec3f cofactors(d[1] * d[2] - r[2] * r[2], d[0] * d[2] - r[1] * r[1], d[0] * d[1] - r[0] * r[0]);
    const Vec3f mixed(r[1] * r[2] - r[0] * d[2], r[0] * r[2] - r[1] * d[1], r[0] * r[1] - d[0] * r[2]);
    const float determinant = d[0] * cofactors[0] + r[0] * mixed[0] + r[1] * mixed[1];
    sound = determinant > kSound;
    if (!sound) return;
    const float inverse = 1 / determinant;
    diagonal = inverse * cofactors, rest = inverse * mixed;
  }
  Vec3f times(const Vec3f& v) const {
    return {diagonal[0] * v[0] + (rest[0] * v[1] + rest[1] * v[2]),
            diagonal[1] * v[1] + (rest[0] * v[0] + rest[2] * v[2]),
            diagonal[2] * v[2] + (rest[1] * v[0] + rest[2] * v[1])};
  }
  /// The trace of its product with a matrix of that diagonal; `others` are the sums of xy and yx, xz and zx,
  /// yz and zy.
  float contract(const Vec3f& onDiagonal, const Vec3f& others) const {
    return diagonal.dot(onDiagonal) + rest.dot(others);
  }
};

/// Where a projection of the velocities works, a value a particle.
struct ProjectionBuffers {
  std::vector<float> potential;        ///< dt p / rho0 (m^2/s)
  std::vector<float> diagonal;         ///< of the matrix (1)
  std::vector<float> missing;          ///< what air leaves out of h grad rho / rho0 (1)
  std::vector<float> inverseDiagonal;  ///< (1)
  std::vector<float> atWall;           ///< what a strain moves through a wall's share of the kernel (m^2/s)
  std::vector<float> residual, image;  ///< (m^2/s)
  std::vector<Float4> velocity;        ///< that a pressure leads to (m/s), with the ghost's; see press.h
  /// Of the conjugate gradients, with the matrix times it (m^2/s).
  std::vector<float> direction, directionImage;
  std::vector<std::uint8_t> active;  ///< whether it has a part in the solve
  std::vector<InverseMoment> inverse;

  /// How much of a particle of that density is inside, 0 to 1, rather than at the surface. It fades between
  /// densities of 0.88 and 0.94: the first layer of water at rest reads 0.8, the second 0.99, and a
  /// disordered packing inside varies by some percent.
  static float inside(float density) { return std::clamp((density - 0.88F) / 0.06F, 0.0F, 1.0F); }

  void resize(std::size_t n) {
    for (std::vector<float>* values : {&potential, &diagonal, &missing, &inverseDiagonal, &atWall, &residual,
                                       &image, &direction, &directionImage})
      values->resize(n);
    active.resize(n), inverse.resize(n);
  }
};

/// What lasts from step to step. gamma is evaluated anew only where a particle has moved, so what was
/// evaluated lasts, too.
struct FluidState {
  static constexpr std::uint32_t kNoWall = std::numeric_limits<std::uint32_t>::max();

  Particles particles;
  /// p / rho0 (m^2/s^2) of the last step, where the next may begin; empty without SolverParameters'
  /// takesPressure().
  std::vector<float> projectedPressure;
  std::vector<WallSlot> wallSlots;
  std::vector<std::uint32_t> wallSlot;  ///< of each particle, or kNoWall
};

/// Where a step works: the memory stays, the values belong to one step. Arrays that passes over neighbours
/// read end with the ghost that fills up the neighbour lists.
struct StepBuffers {
  std::vector<Float4> current;   ///< predicted position (m), then that of the iteration
  std::vector<Float4> previous;  ///< the same an iteration earlier (m); free outside the iterations
  std::vector<Float4> paired;    ///< of the iteration, with the factor that Eq. 10 sums in w; free outside
  /// To take back the step, or energy that it made; without guards only velocities, where a pressure is
  /// taken.
  BeforeStep before;
  std::vector<std::uint32_t> spareIds;  ///< to sort the particles through
  CellGrid grid;
  NeighbourLists neighbours;
  std::vector<float> gamma;
  std::vector<float> density;  ///< rho/rho0
  std::vector<float> lambda;   ///< Eq. 11 over the squared support radius (1)
  ProjectionBuffers projection;
};

/// What happened in a step, for the report.
struct StepRecord {
  std::vector<IterationError> errors;
  int iterations = 0;
  int pressureIterations = 0;  ///< of the projection
  /// What DFSPH's solves have left: the mean error of the density that the step leads to, and the mean
  /// divergence times the step (1).
  double densityLeft = 0, divergenceLeft = 0;

  // Guards that acted.
  long gammaFloored = 0;
  long gammaOutOfRange = 0;  ///< evaluations that ShareRange has counted
  std::vector<SuppressedPush> suppressedPushes;
  long spreadParticles = 0;                         ///< off overfull cells, see stages::spreadOverfullCells
  mutable std::atomic<bool> metCoincident = false;  ///< a pass over pairs met one on one point

  // Energy that the step was given, see core/solver/energy.h.
  WallWork wallWork;
  double effectWork = 0;          ///< by the effects (m^2/s^2); friction at moving walls included
  double velocityEffectWork = 0;  ///< the part of those on velocities (m^2/s^2)

  PressureSum pressure;
  StageTimes times;

  /// Before a step. Errors, work and pressure begin with the stages that add to them.
  void clear() {
    gammaFloored = gammaOutOfRange = spreadParticles = 0;
    suppressedPushes.clear();
    metCoincident = false;
    times.clear();
  }
};

/// All that the stages of a step read and write. Per-particle arrays share one order, along the search grid;
/// `id` tells particles apart across steps. Lengths are metres; densities are rho/rho0; gradients are per
/// support radius, so that nothing over- or underflows with the size of the scene.
struct StepState : FluidState, StepBuffers, StepRecord {
  StepState(ThreadPool& threadPool, const Boundary& walls) : pool(threadPool), boundary(walls) {}

  ThreadPool& pool;
  const Boundary& boundary;
  WallIndex thinWalls;                       ///< thinner than the support radius
  WallIndex collisionWalls;                  ///< of continuous collision: thin walls, and those that move
  const GammaMethod* gammaMethod = nullptr;  ///< null: no correction
  SolverParameters parameters;
  bool guards = true;             ///< see Guards
  Vec3f gravity = Vec3f::Zero();  ///< (m/s^2)
  float spacing = 0;              ///< (m)
  float supportRadius = 0;        ///< (m)
  RestingLattice lattice{};
  float timeStep = 0;    ///< of this substep (s)
  float soundSpeed = 0;  ///< of weakly compressible SPH (m/s)

  bool takesPressure() const { return parameters.takesPressure(); }
  /// Whether the density constraint of PBF has a part in the step.
  bool constrains() const { return parameters.method == SolverMethod::pbf; }
  /// Whether the walls' part of the density is added, rather than divided by gamma.
  bool addsWallDensity() const { return gammaMethod != nullptr && gammaMethod->form() == WallDensity::added; }
  /// What the wall's push on particle i is over the pair gradient of its sample, but for the sign: lambda
  /// times the constraint's derivative with respect to gamma, the slope of besideWalls() left out.
  float wallPush(std::size_t i) const {
    return addsWallDensity() ? lambda[i] : lambda[i] * density[i] / densityGamma(gamma[i]);
  }
  /// The step as a part of the time that takes out noise and evens out a packing: half that in which a
  /// particle falls by its spacing, and not less than a step (1).
  float fallen() const { return std::min(timeStep * 2 * std::sqrt(0.5F * gravity.norm() / spacing), 1.0F); }
  /// What the sum of the neighbours is divided by: gamma, and with a pressure what fluid at rest has of it.
  float densityGamma(float g) const { return takesPressure() ? g * lattice.besideWalls(g) : g; }
  /// Its derivative with respect to gamma.
  float densityGammaSlope(float g) const {
    if (!takesPressure()) return 1;
    return lattice.besideWalls(g) - g * (lattice.wallSlope + 2 * lattice.wallBend * (1 - g));
  }
  /// Whether walls push by depth, and let particles in as far as that.
  bool softWalls() const { return gammaMethod != nullptr && gammaMethod->form() == WallDensity::absent; }
  /// Centres of fluid at rest are this far from walls (m).
  float restingMargin() const { return 0.5F * spacing; }
  /// Centres stay this far inside the fluid side (m).
  float wallMargin() const { return softWalls() ? 0.1F * spacing : restingMargin(); }
};

// A lower bound for a particle's distance from every wall, without evaluating the walls: what was measured
// somewhere, less the way from there. Where that is enough, walls are not evaluated.

/// A clearance (m) that is known at `there`, as known at p.
inline float clearanceAt(const Boundary& boundary, const Vec3f& p, const Vec3f& there, float clearance) {
  return clearance - boundary.steepness() * (p - there).norm();
}

/// The least distance (m) to walls that particle i can have at p, by what its step began with and by its wall
/// slot. 0: nothing is known; always so where walls
/// are not steady.
inline float knownClearance(const StepState& state, std::size_t i, const Vec3f& p) {
  if (!state.boundary.steady()) return 0;
  const Float4& start = state.particles.position[i];
  float clearance = clearanceAt(state.boundary, p, start.xyz(), start.w);
  if (const std::uint32_t slot = state.wallSlot[i]; slot != FluidState::kNoWall) {
    const WallSlot& wall = state.wallSlots[slot];
    clearance = std::max(clearance, clearanceAt(state.boundary, p, wall.at.xyz(), wall.sample.distance));
  }
  return std::max(clearance, 0.0F);
}

/// Whether that distance is known to be at least `wanted` (m).
inline bool knownFarther(const StepState& state, std::size_t i, const Vec3f& p, float wanted) {
  const Boundary& boundary = state.boundary;
  if (!boundary.steady()) return wanted <= 0;
  const auto enough = [&](const Float4& there, float clearance) {
    const float spare = clearance - wanted;
    const float steepness = boundary.steepness();
    return spare >= 0 && steepness * steepness * (p - there.xyz()).squaredNorm() <= spare * spare;
  };
  const Float4& start = state.particles.position[i];
  if (enough(start, start.w)) return true;
  const std::uint32_t slot = state.wallSlot[i];
  return slot != FluidState::kNoWall &&
         enough(state.wallSlots[slot].at, state.wallSlots[slot].sample.distance);
}

// Chebyshev semi-iteration (Golub & Varga 1961; Wang 2015 for position based methods): every Jacobi-like step
// is stretched away from the iterate before the last, x_{k+1} = x_{k-1} + w_k (step(x_k) - x_{k-1}).

/// The weights w_k, one an iteration.
class Chebyshev {
 public:
  /// Of the iteration that follows the given errors, in a solve that ends at `tolerance`. The first two are
  /// 1: they reduce the errors that stretching would amplify. So is the one that is about to end the solve by
  /// itself, going by how much the one before it achieved: stretched, it would overshoot, and fluid at rest
  /// would never come to rest, for nothing pulls back what is pushed apart too far.
  float next(const std::vector<IterationError>& errors, double tolerance) {
    // An estimate of the plain iteration's spectral radius. Larger ones converge faster still at rest, and
    // double the density peaks of impacts.
    constexpr float kRadius2 = 0.9F * 0.9F;
    constexpr std::size_t kPlain = 2;
    if (errors.size() <= kPlain) return 1;
    weight_ = weight_ == 1 ? 2 / (2 - kRadius2) : 4 / (4 - kRadius2 * weight_);
    const double error = errors.back().mean, before = errors[errors.size() - 2].mean;
    return error * error <= tolerance * before ? 1 : weight_;
  }

 private:
  float weight_ = 1;
};

// Which way two particles part that are on one point.

/// A unit direction for two particles on one point, from their ids: antisymmetric, so that momentum is
/// conserved.
inline Vec3f coincidentDirection(std::uint32_t id, std::uint32_t other) {
  const std::uint32_t low = id < other ? id : other, high = id < other ? other : id;
  std::uint32_t bits = low * 0x9E3779B1U ^ (high * 0x85EBCA77U + 0xC2B2AE3DU);
  const auto next = [&bits] {
    bits ^= bits >> 15, bits *= 0x2C1B3C6DU, bits ^= bits >> 12, bits *= 0x297A2D39U, bits ^= bits >> 15;
    return static_cast<float>(bits >> 8) / 8388608.0F - 1;
  };
  const float x = next(), y = next(), z = next();
  const Vec3f direction(x, y, z);
  const float length = direction.norm();
  const Vec3f unit = length > 1e-3F ? Vec3f(direction / length) : Vec3f(Vec3f::UnitX());
  return id < other ? unit : Vec3f(-unit);
}

/// How far apart they are taken to be, over the support radius.
inline constexpr float kCoincident = 1e-5F;

}  // namespace migiwa
