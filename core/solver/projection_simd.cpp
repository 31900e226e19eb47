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
//     + gamma_i min(rho_i/rho0 - 1, 0) / dt                           room that less dense fluid has
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
// gamma(e) says.
//
// The wall is in the divergence alone: by Gauss's theorem the kernel's missing part is a flux through it, and
// the velocity there is the wall's, so that the same flux is missing from the Laplacian; twice, for F_ij is
// twice the slope. Near the surface air is missing from the Laplacian: with a pressure that falls to zero
// over the distance e h to the surface, its part is
//
//   s_i = 2 |(m/rho0) sum_j grad W_ij - rho_i/rho0 grad gamma_i| / (e h)
//
// e being what a density below that of rest says of a plane surface: rho_i/rho0 = gamma(e). That there is
// one, density or the sum itself says. The gradient is exact for a pressure that is linear in space, whatever
// the packing and however few particles lie on one side: water at rest stays at rest. It does not conserve
// momentum to the last digit; where too few neighbours make it ill-conditioned, in spray, the conserving sum
// of pairs stands in for it. The matrix is symmetric and positive definite: conjugate gradients,
// preconditioned by the diagonal, from the pressure of the step before, until a fifth of what that leaves is
// left, or less than the tolerance.
//
// Pressure and velocity have the same places, so there is noise whose divergence reads zero [Rid]. What moves
// positions alone feeds it, and water at rest boils. So a step takes out a viscosity that vanishes with the
// spacing, whatever the time step:
//
//   v_i -= nu dt sum_j F_ij (v*_i - v*_j),   nu = 0.2 spacing^2 / T
//
// T being half the time in which a particle falls by its spacing, and not less than a step.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/solver/solvers.h"
#include "core/solver/step.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/projection_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_PROJECTION_TYPES
#define MIGIWA_PROJECTION_TYPES
namespace migiwa {

/// Of what is left of the equation, in the unit of the solve; the squares over the diagonal.
struct PotentialSums {
  double square = 0, magnitude = 0;
};

}  // namespace migiwa
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// What a step takes of the differences of velocities between neighbours, over F h^2 (1).
inline float filterOf(const StepState& state) {
  constexpr float kOfFall = 0.2F;
  const float spacings = state.spacing / state.supportRadius;
  return kOfFall * state.fallen() * spacings * spacings;
}

/// Density, moment, divergence and diagonal, without the surface's share, what the potential of the step
/// before adds to the neighbours' side of the equation, and the F of the pairs, which stay with the lists.
/// state.previous holds the velocities and, in w, that potential, with the ghost's.
template <class Kernel>
void measureRange(StepState& state, std::size_t begin, std::size_t end) {
  using Shape = KernelVectors<Kernel>;
  const Pairs d;
  const PairScale scale(state);
  const Float4* const positions = state.current.data();
  const Float4* const velocities = state.previous.data();
  ProjectionBuffers& out = state.projection;
  const float slope = state.lattice.massRatio * Shape::kSlope;
  const float support = state.supportRadius, toRoom = support * support / state.timeStep;
  const PairVector toFactor = hn::Set(d, -2 * slope);
  const bool added = state.addsWallDensity();
  state.neighbours.makePairValues(begin / kChunk);
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    const Vec3f own = velocities[i].xyz();
    const PairVector ux = hn::Set(d, own.x()), uy = hn::Set(d, own.y()), uz = hn::Set(d, own.z());
    PairVector covered = hn::Zero(d);
    PairVector sumX = hn::Zero(d), sumY = hn::Zero(d), sumZ = hn::Zero(d);
    PairVector xx = hn::Zero(d), yy = hn::Zero(d), zz = hn::Zero(d);
    PairVector xy = hn::Zero(d), xz = hn::Zero(d), yz = hn::Zero(d);
    // grad W (v_i - v_j)^T, its diagonal and what lies beside it, both sides added.
    PairVector flowX = hn::Zero(d), flowY = hn::Zero(d), flowZ = hn::Zero(d);
    PairVector flowXy = hn::Zero(d), flowXz = hn::Zero(d), flowYz = hn::Zero(d);
    PairVector row = hn::Zero(d), potentials = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    float* const HWY_RESTRICT factors = state.neighbours.pairValues(i);
    prefetchLists(list.data());
    for (std::size_t first = 0; first < list.size(); first += PairBlock::kMost) {
      const std::size_t last = HWY_MIN(first + PairBlock::kMost, list.size());
      PairBlock block;
      for (std::size_t k = first; k < last; k += kPairs) {
        const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
        const Distances<PairVector> r = distances(d, pair.squared);
        covered = hn::Add(covered, Shape::shape(d, r));
        const PairVector push = Shape::push(d, r);
        hn::Store(hn::Mul(toFactor, push), d, &factors[k]);
        const PairVector x = hn::Mul(push, pair.x), y = hn::Mul(push, pair.y), z = hn::Mul(push, pair.z);
        block.store(k - first, x, y, z);
        sumX = hn::Add(sumX, x), sumY = hn::Add(sumY, y), sumZ = hn::Add(sumZ, z);
        xx = hn::MulAdd(x, pair.x, xx), yy = hn::MulAdd(y, pair.y, yy), zz = hn::MulAdd(z, pair.z, zz);
        xy = hn::MulAdd(x, pair.y, xy), xz = hn::MulAdd(x, pair.z, xz), yz = hn::MulAdd(y, pair.z, yz);
      }
      for (std::size_t k = first; k < last; k += kPairs) {
        const Components v = loadComponents(velocities, &list[k]);
        const PairVector factor = hn::Load(d, &factors[k]);
        row = hn::Add(row, factor);
        potentials = hn::MulAdd(factor, v.w, potentials);
        const PairVector x = hn::Load(d, &block.x[k - first]), y = hn::Load(d, &block.y[k - first]);
        const PairVector z = hn::Load(d, &block.z[k - first]);
        const PairVector vx = hn::Sub(ux, v.x), vy = hn::Sub(uy, v.y), vz = hn::Sub(uz, v.z);
        flowX = hn::MulAdd(x, vx, flowX), flowY = hn::MulAdd(y, vy, flowY), flowZ = hn::MulAdd(z, vz, flowZ);
        flowXy = hn::MulAdd(x, vy, hn::MulAdd(y, vx, flowXy));
        flowXz = hn::MulAdd(x, vz, hn::MulAdd(z, vx, flowXz));
        flowYz = hn::MulAdd(y, vz, hn::MulAdd(z, vy, flowYz));
      }
    }
    const Float4 diagonal = sumLanes(xx, yy, zz, covered), rest = sumLanes(xy, xz, yz, row);
    const Float4 flow = sumLanes(flowX, flowY, flowZ, potentials);
    const Float4 flowRest = sumLanes(flowXy, flowXz, flowYz, hn::Zero(d));
    const Float4 sums = sumLanes(sumX, sumY, sumZ, hn::Zero(d));
    const float gamma = state.gamma[i], resting = state.densityGamma(gamma);
    const float sum = state.lattice.massRatio * (Shape::kValue * diagonal.w + Kernel::value(0));
    const float density = correctedDensity(sum, resting, added);
    const float toMoment = -slope * scale.inverseSquare;
    // What pushes by depth has to carry the fluid alone: a gradient that is exact without it holds it up,
    // too.
    const InverseMoment inverse =
        state.softWalls() ? InverseMoment() : InverseMoment(toMoment * diagonal.xyz(), toMoment * rest.xyz());
    float compression = slope * flow.xyz().sum();
    if (inverse.sound) {
      const float third = toMoment * diagonal.xyz().sum() / 3;
      const float exact = third * slope * inverse.contract(flow.xyz(), flowRest.xyz());
      compression += ProjectionBuffers::inside(density) * (exact - compression);
    }
    float source = compression + toRoom * gamma * std::min(density - 1, 0.0F);
    Vec3f missing = slope * scale.inverseSupport * sums.xyz();
    float atWall = 0;
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
        atWall = ProjectionBuffers::inside(density) * length * -slope * strain;
      }
    }
    state.density[i] = density;
    out.residual[i] = source;
    out.atWall[i] = atWall;
    out.image[i] = -flow.w;
    out.diagonal[i] = rest.w;
    out.missing[i] = missing.norm();
    out.inverse[i] = inverse;
  }
}

void measureProjectionOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withOwnGradient(state.parameters.kernel,
                  [&](auto kernel) HWY_ATTR { measureRange<decltype(kernel)>(state, begin, end); });
}

/// image = the matrix times what the w of state.paired hold, of the particles in the solve. Returns the
/// product of the two, a sum over the particles, both over `unit` (m^2/s).
float applyProjectionOfRange(StepState& state, float unit, std::size_t begin, std::size_t end) {
  const Pairs d;
  const Float4* const others = state.paired.data();
  ProjectionBuffers& out = state.projection;
  for (std::size_t i = begin; i < end; ++i) {
    out.image[i] = 0;
    if (!out.active[i]) continue;
    PairVector sum = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const float* const HWY_RESTRICT factors = state.neighbours.pairValues(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs)
      sum = hn::MulAdd(hn::Load(d, &factors[k]), loadComponents(others, &list[k]).w, sum);
    out.image[i] = out.diagonal[i] * others[i].w - sumLanes(sum);
  }
  PairVector product = hn::Zero(d);
  const PairVector inverseUnit = hn::Set(d, 1 / unit);
  for (std::size_t i = begin; i < end; i += kPairs) {
    const std::size_t count = HWY_MIN(kPairs, end - i);
    const PairVector own = hn::Mul(inverseUnit, loadSome(&others[i], count).w);
    product = hn::MulAdd(own, hn::Mul(inverseUnit, loadSome(&out.image[i], count)), product);
  }
  return sumLanes(product);
}

/// A step of the conjugate gradients: `keep` of the direction before stays, `along` is how far it goes. The
/// residual over the diagonal is in the w of state.paired. Returns the sums of what is left, over `unit`.
PotentialSums stepProjectionOfRange(StepState& state, float unit, float keep, float along, std::size_t begin,
                                    std::size_t end) {
  const Pairs d;
  ProjectionBuffers& b = state.projection;
  const PairVector inverseUnit = hn::Set(d, 1 / unit), share = hn::Set(d, keep), far = hn::Set(d, along);
  PairVector square = hn::Zero(d), magnitude = hn::Zero(d);
  for (std::size_t i = begin; i < end; i += kPairs) {
    const std::size_t count = HWY_MIN(kPairs, end - i);
    Components paired = loadSome(&state.paired[i], count);
    const PairVector direction = hn::MulAdd(share, loadSome(&b.direction[i], count), paired.w);
    const PairVector image =
        hn::MulAdd(share, loadSome(&b.directionImage[i], count), loadSome(&b.image[i], count));
    const PairVector residual = hn::NegMulAdd(far, image, loadSome(&b.residual[i], count));
    storeSome(direction, &b.direction[i], count), storeSome(image, &b.directionImage[i], count);
    storeSome(hn::MulAdd(far, direction, loadSome(&b.potential[i], count)), &b.potential[i], count);
    storeSome(residual, &b.residual[i], count);
    paired.w = hn::Mul(residual, loadSome(&b.inverseDiagonal[i], count));
    storeSome(paired, &state.paired[i], count);
    const PairVector left = hn::Mul(inverseUnit, residual);
    square = hn::MulAdd(left, hn::Mul(inverseUnit, paired.w), square);
    magnitude = hn::Add(magnitude, hn::Abs(left));
  }
  return {sumLanes(square), sumLanes(magnitude)};
}

/// v -= grad phi, phi being what the w of state.paired hold, and the noise. state.previous holds the
/// velocities before. The length of grad phi becomes the image.
void pushProjectionOfRange(StepState& state, std::size_t begin, std::size_t end) {
  const Pairs d;
  const PairScale scale(state);
  const Float4* const others = state.paired.data();
  const Float4* const velocities = state.previous.data();
  ProjectionBuffers& buffers = state.projection;
  const float toGradient = -0.5F * scale.inverseSquare;
  const float filter = filterOf(state);
  const bool added = state.addsWallDensity();
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(others[i], scale);
    const Float4& before = velocities[i];
    const PairVector ux = hn::Set(d, before.x), uy = hn::Set(d, before.y), uz = hn::Set(d, before.z);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    PairVector noiseX = hn::Zero(d), noiseY = hn::Zero(d), noiseZ = hn::Zero(d);
    const InverseMoment& inverse = buffers.inverse[i];
    const float phi = others[i].w;
    // Either the difference to the particle's own, or the sum with it.
    const PairVector own = hn::Set(d, inverse.sound ? -phi : phi);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const float* const HWY_RESTRICT factors = state.neighbours.pairValues(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const Components neighbours = loadComponents(others, &list[k]);
      const PairOffsets pair = centre.to(neighbours, &list[k]);
      const PairVector factor = hn::Load(d, &factors[k]), push = hn::Mul(hn::Add(neighbours.w, own), factor);
      x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
      const Components v = loadComponents(velocities, &list[k]);
      noiseX = hn::MulAdd(factor, hn::Sub(ux, v.x), noiseX);
      noiseY = hn::MulAdd(factor, hn::Sub(uy, v.y), noiseY);
      noiseZ = hn::MulAdd(factor, hn::Sub(uz, v.z), noiseZ);
    }
    const Vec3f sum = toGradient * sumLanes(x, y, z, hn::Zero(d)).xyz();
    Vec3f gradient = sum;
    if (inverse.sound) {
      gradient = inverse.times(sum);
    } else if (state.wallSlot[i] != FluidState::kNoWall) {
      const float fall = (added ? 1 : state.density[i]) * phi * scale.inverseSupport;
      gradient -= fall * state.wallSlots[state.wallSlot[i]].sample.pairGradient;
    }
    buffers.image[i] = gradient.norm();
    const Vec3f noise = filter * sumLanes(noiseX, noiseY, noiseZ, hn::Zero(d)).xyz();
    Float4& velocity = state.particles.velocity[i];
    velocity = Float4(Vec3f(velocity.xyz() - gradient - noise));
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(measureProjectionOfRange);
HWY_EXPORT(applyProjectionOfRange);
HWY_EXPORT(stepProjectionOfRange);
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

PotentialSums addPotentialSums(const PotentialSums& a, const PotentialSums& b) {
  return {a.square + b.square, a.magnitude + b.magnitude};
}

/// Conjugate gradients for the potential, with the sums of an iteration in one place [CGe].
class PotentialSolve {
 public:
  /// `left`: what the potential of the step before leaves of the equation.
  PotentialSolve(StepState& state, const PotentialSums& left)
      : state_(state), unit_(residualUnit(state)), left_(left) {}

  /// What a residual is of a divergence that closes all room in a step (m^2/s).
  static float residualUnit(const StepState& state) {
    return state.supportRadius * state.supportRadius / state.timeStep;
  }

  void run() {
    const SolverParameters& parameters = state_.parameters;
    const auto mean = [&] {
      return left_.magnitude / static_cast<double>(std::max<std::size_t>(state_.particles.size(), 1));
    };
    constexpr double kLeft = 0.2;  // of the divergence that the pressure of the step before leaves
    const double enough = std::max(parameters.divergenceTolerance, kLeft * mean());
    // Fluid that walls leave no room has no solution, and what is left of its equation grows without end.
    constexpr double kMostGrowth = 4;
    double along = 0, before = 0, least = left_.square;
    state_.pressureIterations = 0;
    while (state_.pressureIterations < parameters.maxPressureIterations && left_.square > 0 &&
           mean() > enough && left_.square < kMostGrowth * kMostGrowth * least) {
      least = std::min(least, left_.square);
      const double keep = state_.pressureIterations > 0 ? left_.square / before : 0;
      const double product = apply() - (along != 0 ? keep * left_.square / along : 0);
      if (!(product > 0)) break;
      along = left_.square / product;
      before = left_.square;
      step(static_cast<float>(keep), static_cast<float>(along));
      ++state_.pressureIterations;
    }
  }

 private:
  double apply() {
    const auto ofRange = HWY_DYNAMIC_DISPATCH(applyProjectionOfRange);
    return parallelReduce(
        state_.pool, state_.particles.size(), 0.0,
        [&](std::size_t begin, std::size_t end) {
          return static_cast<double>(ofRange(state_, unit_, begin, end));
        },
        [](double a, double b) { return a + b; });
  }
  void step(float keep, float along) {
    const auto ofRange = HWY_DYNAMIC_DISPATCH(stepProjectionOfRange);
    left_ = parallelReduce(
        state_.pool, state_.particles.size(), PotentialSums{},
        [&](std::size_t begin, std::size_t end) { return ofRange(state_, unit_, keep, along, begin, end); },
        addPotentialSums);
  }

  StepState& state_;
  float unit_;
  PotentialSums left_;
};

/// Memory, and what the passes over pairs gather: positions, velocities, the potential of the step before.
void prepareProjection(StepState& state) {
  const std::size_t n = state.particles.size();
  state.projection.resize(n);
  state.density.resize(n);
  resizeTight(state.previous, n + 1);
  resizeTight(state.paired, n + 1);
  state.paired[n] = Float4(state.neighbours.ghost().xyz());
  state.previous[n] = Float4();
  parallelEach(state.pool, n, [&](std::size_t i) {
    const float potential = state.timeStep * state.projectedPressure[i];
    state.projection.potential[i] = potential;
    state.previous[i] = Float4(state.particles.velocity[i].xyz(), potential);
  });
}

/// How much of a particle is at the surface, 0 to 1: by its density, or by what is missing on one side, which
/// is 1.1 in the first layer of water at rest, 0.1 below it and 0.6 in one of twenty of a disordered packing.
/// Fluid whose first layer a flow presses together would else have no surface, and its pressure no bound.
float outsideOf(float density, float missing) {
  return std::max(1 - ProjectionBuffers::inside(density), std::clamp((missing - 0.6F) / 0.4F, 0.0F, 1.0F));
}

/// The equation, and what the potential of the step before leaves of it.
PotentialSums measureProjection(StepState& state) {
  const auto ofRange = HWY_DYNAMIC_DISPATCH(measureProjectionOfRange);
  const PlaneDistance& distance = PlaneDistance::of(state.parameters.kernel);
  const float nearest = 0.25F * state.spacing / state.supportRadius;
  const double toUnit = 1 / static_cast<double>(PotentialSolve::residualUnit(state));
  ProjectionBuffers& b = state.projection;
  return parallelReduce(
      state.pool, state.particles.size(), PotentialSums{},
      [&](std::size_t begin, std::size_t end) {
        PotentialSums sums;
        ofRange(state, begin, end);
        for (std::size_t i = begin; i < end; ++i) {
          float residual = b.residual[i], diagonal = b.diagonal[i];
          if (b.atWall[i] != 0) residual += distance(state.gamma[i]) * b.atWall[i];
          // A lone particle has no neighbours to make a diagonal of, and no pressure.
          constexpr float kLeast = 1e-6F;
          diagonal = std::max(diagonal, kLeast);
          if (const float outside = outsideOf(state.density[i], b.missing[i]); outside > 0)
            diagonal += b.missing[i] * outside * 2 / std::max(distance(state.density[i]), nearest);
          residual -= diagonal * b.potential[i] + b.image[i];
          // Particles without pressure that do not come together have no part in the solve.
          const bool active = b.potential[i] > 0 || residual > 0;
          if (!active) residual = 0;
          const float inverse = 1 / diagonal, start = residual * inverse;
          b.active[i] = active ? 1 : 0;
          b.residual[i] = residual, b.diagonal[i] = diagonal, b.inverseDiagonal[i] = inverse;
          b.direction[i] = b.directionImage[i] = 0;
          state.paired[i] = Float4(state.current[i].xyz(), start);
          const double left = toUnit * static_cast<double>(residual);
          sums.square += left * toUnit * static_cast<double>(start);
          sums.magnitude += std::abs(left);
        }
        return sums;
      },
      addPotentialSums);
}

}  // namespace

void stages::projectVelocities(StepState& state) {
  const std::size_t n = state.particles.size();
  prepareProjection(state);
  PotentialSolve(state, measureProjection(state)).run();
  const float inverseStep = 1 / state.timeStep;
  ProjectionBuffers& buffers = state.projection;
  parallelEach(state.pool, n, [&](std::size_t i) {
    const float potential = std::max(buffers.potential[i], 0.0F);
    buffers.potential[i] = state.paired[i].w = potential;
    state.projectedPressure[i] = inverseStep * potential;
  });
  const auto push = HWY_DYNAMIC_DISPATCH(pushProjectionOfRange);
  parallelFor(state.pool, n,
              [&](std::size_t begin, std::size_t end, std::size_t) { push(state, begin, end); });
  state.pressure.project(state);
  if (state.boundary.moves()) state.wallWork.add(projectionWork(state));
}

}  // namespace migiwa
#endif  // HWY_ONCE
