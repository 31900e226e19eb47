// The velocity step "projection": pressure makes the velocities free of divergence, and particles move with
// them; the density constraint then corrects positions alone.
//
// METHOD: docs/method.md, "Velocities by projection", has the equations. With phi = dt p / rho0, everything
// at the places x where the step begins, and the equation multiplied by gamma_i:
//
//   v = v* - grad phi, phi >= 0                       (incompressible SPH, Cummins & Rudman 1999)
//
//   sum_j F_ij (phi_i - phi_j) + s_i phi_i
//     = t_i (m/rho0) sum_j B_i grad W_ij . (v*_i - v*_j)              compression by the neighbours
//     - 2 rho_i/rho0 grad gamma_i . (v*_i - e h/2 L_i n_i - v_wall)   and by the wall
//     + gamma_i min(rho_i/rho0 - 1, 0) / T                            room that less dense fluid has
//   F_ij = -2 (m/rho0) W'(r_ij) / r_ij
//
//   grad phi_i = B_i (m/rho0) sum_j (phi_j - phi_i) grad W_ij
//   B_i^-1 = -(m/rho0) sum_j grad W_ij (x_i - x_j)^T, t_i a third of its trace
//
// Both are exact for what is linear in space. Without B a packing that a flow has stretched reads compression
// where there is none: it resists shear as a solid does, and gives energy back when it yields. The plain sum
// of pairs, B = 1 and t = 1, stays towards the surface, where one side is missing and B grows. Beside a plane
// the plain sum of a continuum reads what a strain L moves along the normal n, e h grad gamma . L n, which B
// leaves out: half of what the velocity changes on the way e h to the wall puts it back, e being what
// gamma(e) says. Room closes in the time T rather than in a step: what a step takes of it at once comes back
// as a push in the next, and water at rest trembles. T is half the time in which a particle falls by its
// spacing, and not less than a step.
//
// The wall is in the divergence alone: by Gauss's theorem the kernel's missing part is a flux through it, and
// the velocity there is the wall's, so that the same flux is missing from the Laplacian; twice, for F_ij is
// twice the slope. Near the surface air is missing from the Laplacian: with a pressure that falls to zero
// over the distance e h to the surface, its part is
//
//   s_i = 2 |(m/rho0) sum_j grad W_ij - rho_i/rho0 grad gamma_i| / (e h)
//
// e being what a density below that of rest says of a plane surface: rho_i/rho0 = gamma(e). The gradient is
// exact for a pressure that is linear in space, whatever the packing of the particles and however few lie on
// one side: water at rest stays at rest. It does not conserve momentum to the last digit; where too few
// neighbours make it ill-conditioned, in spray, the conserving sum of pairs stands in for it. The matrix is
// symmetric and positive definite: conjugate gradients, preconditioned by the diagonal, from the pressure of
// the step before, until a fifth of what that leaves is left, or less than the tolerance.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/solver/step.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/projection_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// use(kernel) for the kernels whose own gradient moves particles.
template <class Use>
HWY_INLINE void withOwnGradient(KernelType kernel, const Use& use) {
  if (kernel == KernelType::cubicSpline) return use(CubicSpline{});
  use(WendlandC2{});
}

/// One over the time in which less dense fluid comes together (1/s).
inline float roomRate(const StepState& state) {
  constexpr float kFalls = 0.5F;  // of the time in which a particle falls by its spacing
  const float once = 1 / state.timeStep, gravity = state.gravity.norm();
  return gravity > 0 ? std::min(once, std::sqrt(0.5F * gravity / state.spacing) / kFalls) : once;
}

/// Density, moment, divergence and diagonal, without the surface's share. state.previous holds the
/// velocities, with the ghost's.
template <class Kernel>
void measureRange(StepState& state, std::size_t begin, std::size_t end) {
  using Shape = KernelVectors<Kernel>;
  const Pairs d;
  const PairScale scale(state);
  const Float4* const positions = state.current.data();
  const Float4* const velocities = state.previous.data();
  ProjectionBuffers& out = state.projection;
  const float slope = state.lattice.massRatio * Shape::kSlope;
  const float support = state.supportRadius, toRoom = support * support * roomRate(state);
  const bool added = state.addsWallDensity();
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    const Vec3f own = velocities[i].xyz();
    const PairVector ux = hn::Set(d, own.x()), uy = hn::Set(d, own.y()), uz = hn::Set(d, own.z());
    PairVector covered = hn::Zero(d), pushes = hn::Zero(d);
    PairVector sumX = hn::Zero(d), sumY = hn::Zero(d), sumZ = hn::Zero(d);
    PairVector xx = hn::Zero(d), yy = hn::Zero(d), zz = hn::Zero(d);
    PairVector xy = hn::Zero(d), xz = hn::Zero(d), yz = hn::Zero(d);
    // grad W (v_i - v_j)^T, its diagonal and what lies beside it, both sides added.
    PairVector flowX = hn::Zero(d), flowY = hn::Zero(d), flowZ = hn::Zero(d);
    PairVector flowXy = hn::Zero(d), flowXz = hn::Zero(d), flowYz = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Components v = loadComponents(velocities, &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      covered = hn::Add(covered, Shape::shape(d, r));
      const PairVector push = Shape::push(d, r);
      pushes = hn::Add(pushes, push);
      const PairVector x = hn::Mul(push, pair.x), y = hn::Mul(push, pair.y), z = hn::Mul(push, pair.z);
      sumX = hn::Add(sumX, x), sumY = hn::Add(sumY, y), sumZ = hn::Add(sumZ, z);
      const PairVector vx = hn::Sub(ux, v.x), vy = hn::Sub(uy, v.y), vz = hn::Sub(uz, v.z);
      flowX = hn::MulAdd(x, vx, flowX), flowY = hn::MulAdd(y, vy, flowY), flowZ = hn::MulAdd(z, vz, flowZ);
      flowXy = hn::MulAdd(x, vy, hn::MulAdd(y, vx, flowXy));
      flowXz = hn::MulAdd(x, vz, hn::MulAdd(z, vx, flowXz));
      flowYz = hn::MulAdd(y, vz, hn::MulAdd(z, vy, flowYz));
      xx = hn::MulAdd(x, pair.x, xx), yy = hn::MulAdd(y, pair.y, yy), zz = hn::MulAdd(z, pair.z, zz);
      xy = hn::MulAdd(x, pair.y, xy), xz = hn::MulAdd(x, pair.z, xz), yz = hn::MulAdd(y, pair.z, yz);
    }
    const Float4 diagonal = sumLanes(xx, yy, zz, covered), rest = sumLanes(xy, xz, yz, pushes);
    const Float4 flow = sumLanes(flowX, flowY, flowZ, hn::Zero(d));
    const Float4 flowRest = sumLanes(flowXy, flowXz, flowYz, hn::Zero(d));
    const Float4 sums = sumLanes(sumX, sumY, sumZ, hn::Zero(d));
    const float gamma = state.gamma[i], resting = state.densityGamma(gamma);
    float density = state.lattice.massRatio * (Shape::kValue * diagonal.w + Kernel::value(0));
    density = added ? density + 1 - resting : density / resting;
    const float toMoment = -slope * scale.inverseSquare;
    const InverseMoment inverse(toMoment * diagonal.xyz(), toMoment * rest.xyz());
    float compression = slope * flow.xyz().sum();
    if (inverse.sound) {
      const float third = toMoment * diagonal.xyz().sum() / 3;
      const float exact = third * slope * inverse.contract(flow.xyz(), flowRest.xyz());
      compression += ProjectionBuffers::inside(density) * (exact - compression);
    }
    float source = compression + toRoom * gamma * std::min(density - 1, 0.0F);
    Vec3f missing = slope * scale.inverseSupport * sums.xyz();
    out.image[i] = 0;
    if (state.wallSlot[i] != FluidState::kNoWall) {
      const Vec3f wall = (added ? 1 : density) * state.wallSlots[state.wallSlot[i]].sample.pairGradient;
      const Vec3f relative = own - state.boundary.wallVelocity(positions[i].xyz());
      source -= 2 * support * wall.dot(relative);
      missing -= wall;
      if (const float length = wall.norm(); inverse.sound && length > 0) {
        const Vec3f normal = wall / length, along = inverse.times(normal);
        const Vec3f mixed(along.x() * normal.y() + along.y() * normal.x(),
                          along.x() * normal.z() + along.z() * normal.x(),
                          along.y() * normal.z() + along.z() * normal.y());
        const float strain = along.cwiseProduct(normal).dot(flow.xyz()) + 0.5F * mixed.dot(flowRest.xyz());
        out.image[i] = ProjectionBuffers::inside(density) * length * -slope * strain;
      }
    }
    state.density[i] = density;
    out.residual[i] = source;
    out.diagonal[i] = -2 * slope * rest.w;
    out.missing[i] = missing.norm();
    out.inverse[i] = inverse;
  }
}

void measureProjectionOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withOwnGradient(state.parameters.kernel,
                  [&](auto kernel) HWY_ATTR { measureRange<decltype(kernel)>(state, begin, end); });
}

/// image = the matrix times what the w of state.paired hold.
template <class Kernel>
void applyRange(StepState& state, std::size_t begin, std::size_t end) {
  using Shape = KernelVectors<Kernel>;
  const Pairs d;
  const PairScale scale(state);
  const Float4* const others = state.paired.data();
  ProjectionBuffers& out = state.projection;
  const float toMatrix = -2 * state.lattice.massRatio * Shape::kSlope;
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(others[i], scale);
    PairVector sum = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const Components neighbours = loadComponents(others, &list[k]);
      const PairOffsets pair = centre.to(neighbours, &list[k]);
      sum = hn::MulAdd(Shape::push(d, distances(d, pair.squared)), neighbours.w, sum);
    }
    out.image[i] = out.diagonal[i] * others[i].w - toMatrix * sumLanes(sum);
  }
}

void applyProjectionOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withOwnGradient(state.parameters.kernel,
                  [&](auto kernel) HWY_ATTR { applyRange<decltype(kernel)>(state, begin, end); });
}

/// v -= grad phi, phi being what the w of state.paired hold.
template <class Kernel>
void pushRange(StepState& state, std::size_t begin, std::size_t end) {
  using Shape = KernelVectors<Kernel>;
  const Pairs d;
  const PairScale scale(state);
  const Float4* const others = state.paired.data();
  const ProjectionBuffers& in = state.projection;
  const float toGradient = state.lattice.massRatio * Shape::kSlope * scale.inverseSquare;
  const bool added = state.addsWallDensity();
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(others[i], scale);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    const InverseMoment& inverse = in.inverse[i];
    const float phi = others[i].w;
    // Either the difference to the particle's own, or the sum with it.
    const PairVector own = hn::Set(d, inverse.sound ? -phi : phi);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const Components neighbours = loadComponents(others, &list[k]);
      const PairOffsets pair = centre.to(neighbours, &list[k]);
      const PairVector push = hn::Mul(hn::Add(neighbours.w, own), Shape::push(d, distances(d, pair.squared)));
      x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
    }
    const Vec3f sum = toGradient * sumLanes(x, y, z, hn::Zero(d)).xyz();
    Vec3f gradient = sum;
    if (inverse.sound) {
      gradient = inverse.times(sum);
    } else if (state.wallSlot[i] != FluidState::kNoWall) {
      const float fall = (added ? 1 : state.density[i]) * phi * scale.inverseSupport;
      gradient -= fall * state.wallSlots[state.wallSlot[i]].sample.pairGradient;
    }
    Float4& velocity = state.particles.velocity[i];
    velocity = Float4(Vec3f(velocity.xyz() - gradient));
  }
}

void pushProjectionOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withOwnGradient(state.parameters.kernel,
                  [&](auto kernel) HWY_ATTR { pushRange<decltype(kernel)>(state, begin, end); });
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(measureProjectionOfRange);
HWY_EXPORT(applyProjectionOfRange);
HWY_EXPORT(pushProjectionOfRange);

namespace {

/// e over gamma(e): how far from a plane, in support radii, that share of the kernel is left. A table.
class PlaneDistance {
 public:
  /// For one of the kernels whose own gradient moves particles; made once.
  static const PlaneDistance& of(KernelType kernel) {
    static const PlaneDistance ofSpline(KernelType::cubicSpline), ofWendland(KernelType::wendlandC2);
    return kernel == KernelType::cubicSpline ? ofSpline : ofWendland;
  }
  float operator()(float share) const {
    const float at = std::clamp(share, 0.0F, 1.0F) * static_cast<float>(values_.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(at), values_.size() - 2);
    return values_[k] + (at - static_cast<float>(k)) * (values_[k + 1] - values_[k]);
  }

 private:
  explicit PlaneDistance(KernelType kernel) {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(values_.size() - 1);
      float low = 0, high = 1;  // gamma grows with e
      for (int halving = 0; halving < 24; ++halving) {
        const float middle = 0.5F * (low + high);
        (withKernel(kernel, [&](auto shape) { return shape.planeGamma(middle); }) < share ? low : high) =
            middle;
      }
      values_[k] = high;
    }
  }

  std::array<float, 257> values_{};
};

/// Conjugate gradients for the potential.
class PotentialSolve {
 public:
  explicit PotentialSolve(StepState& state) : state_(state), b_(state.projection) {}

  void run() {
    const std::size_t n = state_.particles.size();
    const SolverParameters& parameters = state_.parameters;
    begin();
    // What is left of the divergence, as the mean density error that it makes in a step.
    const double toError =
        static_cast<double>(state_.timeStep) /
        (static_cast<double>(state_.supportRadius) * static_cast<double>(state_.supportRadius)) /
        static_cast<double>(std::max<std::size_t>(n, 1));
    Sums sums = precondition();
    constexpr double kLeft = 0.2;  // of the divergence that the pressure of the step before leaves
    const double enough = std::max(parameters.divergenceTolerance, kLeft * sums.magnitude * toError);
    state_.pressureIterations = 0;
    while (state_.pressureIterations < parameters.maxPressureIterations && sums.square > 0 &&
           sums.magnitude * toError > enough) {
      apply();
      const double curvature = parallelSum(state_.pool, state_.particles.size(), [&](std::size_t i) {
        if (!b_.active[i]) b_.image[i] = 0;
        return static_cast<double>(b_.image[i]) * static_cast<double>(state_.paired[i].w);
      });
      if (!(curvature > 0)) break;
      const auto along = static_cast<float>(sums.square / curvature);
      parallelEach(state_.pool, state_.particles.size(), [&](std::size_t i) {
        b_.potential[i] += along * state_.paired[i].w;
        b_.residual[i] -= along * b_.image[i];
      });
      const double before = sums.square;
      sums = precondition();
      const auto keep = static_cast<float>(sums.square / before);
      parallelEach(state_.pool, state_.particles.size(), [&](std::size_t i) {
        state_.paired[i].w = b_.residual[i] / b_.diagonal[i] + keep * state_.paired[i].w;
      });
      ++state_.pressureIterations;
    }
  }

 private:
  struct Sums {
    double square = 0;     ///< of the residual over the diagonal
    double magnitude = 0;  ///< of the residual (m^2/s)
  };

  /// The residual of the pressure of the step before, and the first direction.
  void begin() {
    const float dt = state_.timeStep;
    parallelEach(state_.pool, state_.particles.size(), [&](std::size_t i) {
      b_.potential[i] = dt * state_.projectedPressure[i];
      state_.paired[i] = Float4(state_.current[i].xyz(), b_.potential[i]);
    });
    apply();
    parallelEach(state_.pool, state_.particles.size(), [&](std::size_t i) {
      float& residual = b_.residual[i];
      residual -= b_.image[i];
      // Particles without pressure that do not come together have no part in the solve.
      b_.active[i] = b_.potential[i] > 0 || residual > 0 ? 1 : 0;
      if (!b_.active[i]) residual = 0;
      state_.paired[i].w = residual / b_.diagonal[i];
    });
  }
  void apply() {
    const auto ofRange = HWY_DYNAMIC_DISPATCH(applyProjectionOfRange);
    parallelFor(state_.pool, state_.particles.size(),
                [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state_, begin, end); });
  }
  Sums precondition() const {
    return parallelReduce(
        state_.pool, state_.particles.size(), Sums{},
        [&](std::size_t begin, std::size_t end) {
          Sums part;
          for (std::size_t i = begin; i < end; ++i) {
            const auto residual = static_cast<double>(b_.residual[i]);
            part.square += residual * residual / static_cast<double>(b_.diagonal[i]);
            part.magnitude += std::abs(residual);
          }
          return part;
        },
        [](const Sums& a, const Sums& b) {
          return Sums{a.square + b.square, a.magnitude + b.magnitude};
        });
  }

  StepState& state_;
  ProjectionBuffers& b_;
};

/// Work of the pressure on moving walls' account: its impulse on each particle times the wall's velocity.
double pressureWork(const StepState& state) {
  return parallelSum(state.pool, state.wallSlots.size(), [&](std::size_t k) {
    const WallSlot& slot = state.wallSlots[k];
    const std::size_t i = slot.particle;
    const float fall = state.addsWallDensity() ? 1 : state.density[i];
    const float push = 2 * state.timeStep * state.projection.potential[i] * fall / state.supportRadius;
    const Vec3f velocity = state.boundary.wallVelocity(slot.at.xyz());
    return static_cast<double>(push * slot.sample.pairGradient.dot(velocity));
  });
}

}  // namespace

void stages::projectVelocities(StepState& state) {
  const std::size_t n = state.particles.size();
  ProjectionBuffers& buffers = state.projection;
  buffers.resize(n);
  state.density.resize(n);
  resizeTight(state.previous, n + 1);
  resizeTight(state.paired, n + 1);
  state.paired[n] = Float4(state.neighbours.ghost().xyz());
  state.previous[n] = Float4();
  std::copy(state.particles.velocity.begin(), state.particles.velocity.end(), state.previous.begin());
  const auto measure = HWY_DYNAMIC_DISPATCH(measureProjectionOfRange);
  const PlaneDistance& distance = PlaneDistance::of(state.parameters.kernel);
  const float nearest = 0.25F * state.spacing / state.supportRadius;
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    measure(state, begin, end);
    for (std::size_t i = begin; i < end; ++i) {
      if (buffers.image[i] != 0) buffers.residual[i] += distance(state.gamma[i]) * buffers.image[i];
      // A lone particle has no neighbours to make a diagonal of, and no pressure.
      constexpr float kLeast = 1e-6F;
      buffers.diagonal[i] = std::max(buffers.diagonal[i], kLeast);
      if (const float outside = 1 - ProjectionBuffers::inside(state.density[i]); outside > 0)
        buffers.diagonal[i] +=
            buffers.missing[i] * outside * 2 / std::max(distance(state.density[i]), nearest);
    }
  });
  PotentialSolve(state).run();
  const float inverseStep = 1 / state.timeStep;
  parallelEach(state.pool, n, [&](std::size_t i) {
    const float potential = std::max(buffers.potential[i], 0.0F);
    buffers.potential[i] = state.paired[i].w = potential;
    state.projectedPressure[i] = inverseStep * potential;
  });
  const auto push = HWY_DYNAMIC_DISPATCH(pushProjectionOfRange);
  parallelFor(state.pool, n,
              [&](std::size_t begin, std::size_t end, std::size_t) { push(state, begin, end); });
  if (state.boundary.moves()) state.wallWork.add(pressureWork(state));
}

}  // namespace migiwa
#endif  // HWY_ONCE
