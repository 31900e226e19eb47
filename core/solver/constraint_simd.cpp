// The two passes over pairs of an iteration: lambda, then the positions.
#include <algorithm>

#include "core/solver/step.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/constraint_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_CONSTRAINT_TYPES
#define MIGIWA_CONSTRAINT_TYPES
namespace migiwa::stages {

struct ErrorSum {
  double sum = 0, squares = 0;
  float max = 0;
};

}  // namespace migiwa::stages
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

// METHOD: density [FM] Eq. 5, constraint Eq. 9, its gradients Eqs. 12 and 13 and lambda Eq. 11. Gradients are
// taken from the pair kernel, as in Macklin & Mueller 2013, gamma's included. Deviation: the constraint is
// clamped at zero, for the paper is silent on free surfaces and fluid clumps otherwise. Methods that add the
// walls' density instead of dividing by gamma have C = S + (1 - gamma) - 1, with the gradients that follow.

/// four: the sum of the pair kernel's pushes, and that of the density kernel's shape, the particle itself
/// left out; fifth: the sum of the pair kernel's squared slopes. Without the kernels' constants.
template <class Kernel, class Centre>
HWY_INLINE PairSums sumNeighbours(const StepState& state, const Centre& centre, std::size_t i) {
  using Density = KernelVectors<Kernel>;
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const Pairs d;
  const Float4* const others = state.current.data();
  PairVector covered = hn::Zero(d), slopes = hn::Zero(d), x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
  Coincidence<Pair> coincidence;
  const std::span<const std::uint32_t> list = state.neighbours.groups(i);
  prefetchLists(list.data());
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const PairOffsets pair = centre.to(loadComponents(others, &list[k]), &list[k]);
    const Distances<PairVector> r = distances(d, pair.squared);
    covered = hn::Add(covered, Density::shape(d, r));
    const PairVector push = Pair::push(d, r);
    slopes = hn::Add(slopes, Pair::squaredSlope(d, r, push));
    x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
    coincidence.meet(r.q2);
  }
  const Float4 sums = sumLanes(x, y, z, covered);
  return {sums, sumLanes(slopes), coincidence.met(sums)};
}

template <class Kernel>
stages::ErrorSum lambdaOfRange(StepState& state, std::size_t begin, std::size_t end) {
  using Density = KernelVectors<Kernel>;
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const Pairs d;
  const float massRatio = state.lattice.massRatio;
  const float epsilon = static_cast<float>(state.parameters.cfmEpsilon) * state.lattice.squaredGradients;
  const bool divideByGamma = state.parameters.positionStep == PositionStep::gradient;
  const bool added = state.addsWallDensity();
  const float wallSlope = state.takesPressure() ? state.lattice.wallSlope : 0;
  const float wallBend = state.takesPressure() ? state.lattice.wallBend : 0;
  const PairScale scale(state);
  const PairVector one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  const auto ofNeighbours = [&state](const auto& centre, std::size_t i)
                                HWY_ATTR { return sumNeighbours<Kernel>(state, centre, i); };
  stages::ErrorSum error;
  // Also where the constraint is zero: a branch on it would be mispredicted.
  const auto solve = [&](std::size_t first, std::size_t count, const Float4* four,
                         const float* fifth) HWY_ATTR {
    const Components sums = loadSome(four, kPairs);
    const PairVector continuum = loadSome(&state.gamma[first], count);
    const PairVector beyond = hn::Sub(one, continuum);
    const PairVector gamma = hn::MulAdd(hn::Mul(continuum, beyond),
                                        hn::MulAdd(beyond, hn::Set(d, wallBend), hn::Set(d, wallSlope)),
                                        continuum);  // gamma times besideWalls()
    const PairVector inverseGamma = added ? one : hn::Div(one, gamma);
    PairVector density = hn::Mul(
        hn::MulAdd(hn::Set(d, massRatio * Density::kValue), sums.w, hn::Set(d, massRatio * Kernel::value(0))),
        inverseGamma);
    if (added) density = hn::Add(density, hn::Sub(one, gamma));
    // In this order what is not a number stays so.
    const PairVector constraint = hn::Max(zero, hn::Sub(density, one));
    const Vectors wall = gatherAtWalls(state.wallSlot.data(), first, count, [&state](std::size_t i) {
      return state.wallSlots[state.wallSlot[i]].sample.pairGradient;
    });
    const PairVector toGradient = hn::Set(d, massRatio * scale.inverseSupport * Pair::kSlope);
    const PairVector fall = added ? one : density;
    const PairVector x = hn::NegMulAdd(fall, wall.x, hn::Mul(toGradient, sums.x));
    const PairVector y = hn::NegMulAdd(fall, wall.y, hn::Mul(toGradient, sums.y));
    const PairVector z = hn::NegMulAdd(fall, wall.z, hn::Mul(toGradient, sums.z));
    const float slope = massRatio * Pair::kSlope;
    const PairVector squared = hn::MulAdd(
        x, x, hn::MulAdd(y, y, hn::MulAdd(z, z, hn::Mul(hn::Set(d, slope * slope), hn::LoadU(d, fifth)))));
    const PairVector squaredGradients = hn::Mul(squared, hn::Mul(inverseGamma, inverseGamma));
    const PairVector lambda =
        hn::Sub(zero, hn::Div(constraint, hn::Add(squaredGradients, hn::Set(d, epsilon))));
    storeSome(density, &state.density[first], count);
    storeSome(lambda, &state.lambda[first], count);
    Components paired = loadSome(&state.current[first], count);
    paired.w = divideByGamma ? hn::Mul(lambda, inverseGamma) : lambda;
    storeSome(paired, &state.paired[first], count);
    alignas(32) float errors[kPairs];
    hn::Store(constraint, d, errors);
    for (std::size_t k = 0; k < count; ++k) {
      error.sum += static_cast<double>(errors[k]);
      error.squares += static_cast<double>(errors[k] * errors[k]);
      error.max = std::max(error.max, errors[k]);
    }
  };
  forBlocks(state.current.data(), scale, begin, end, ofNeighbours, solve);
  return error;
}

stages::ErrorSum computeLambdaOfRange(StepState& state, std::size_t begin, std::size_t end) {
  return withKernel(state.parameters.kernel,
                    [&](auto kernel) HWY_ATTR { return lambdaOfRange<decltype(kernel)>(state, begin, end); });
}

// METHOD: the displacement of [FM] Eq. 10 in three forms, see PositionStep.
// Deviation: the default is the constraint's true gradient step,
//   dx_i = (m/rho0) sum_j (lambda_i/gamma_i + lambda_j/gamma_j) grad W_ij - lambda_i rho_i/(rho0 gamma_i)
//   grad gamma_i,
// whose last term is the wall pushing back; Eq. 10 as printed lets particles crowd the wall.
//
// Where a pressure makes the velocities, particles follow the flow, and a packing that it has stretched stays
// stretched: pairs come nearer than three quarters of a spacing, read denser than fluid at rest, and a wave
// that lifts the fluid by that grows. So what moves positions alone evens the packing out, too: it goes down
// the density's gradient [LXSR],
//   dx_i -= d_i ((m/rho0) sum_j grad W_ij - rho_i/rho0 grad gamma_i),
// by the push of a density error of 0.03 dt / T, T being that of the projection; inside only, for
// at the surface there is a gradient by nature.

/// How far particle i goes down the density's gradient, as a lambda over gamma.
inline float eveningOf(const StepState& state, std::size_t i) {
  constexpr float kError = 0.03F;
  if (!state.takesPressure()) return 0;
  return kError * state.fallen() / state.lattice.squaredGradients *
         ProjectionBuffers::inside(state.density[i]);
}

/// Sum over the neighbours of (w_i + w_j) times the push of the pair kernel, without its constant.
template <class Kernel, class Centre>
HWY_INLINE PairSums pushOfPairs(const StepState& state, const Centre& centre, std::size_t i) {
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const Pairs d;
  const Float4* const others = state.paired.data();
  const PairVector own = hn::Set(d, others[i].w - eveningOf(state, i));
  PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
  Coincidence<Pair> coincidence;
  const std::span<const std::uint32_t> list = state.neighbours.groups(i);
  prefetchLists(list.data());
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const Components neighbours = loadComponents(others, &list[k]);
    const PairOffsets pair = centre.to(neighbours, &list[k]);
    const Distances<PairVector> r = distances(d, pair.squared);
    const PairVector push = hn::Mul(hn::Add(own, neighbours.w), Pair::push(d, r));
    x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
    coincidence.meet(r.q2);
  }
  const Float4 sums = sumLanes(x, y, z, hn::Zero(d));
  return {sums, 0, coincidence.met(sums)};
}

template <class Kernel>
void moveRange(StepState& state, float weight, std::size_t begin, std::size_t end) {
  const Pairs d;
  const bool wallPush = state.parameters.positionStep != PositionStep::paper;
  const PairScale scale(state);
  const float toWay =
      state.lattice.massRatio * scale.inverseSupport * KernelVectors<PairKernel<Kernel>>::kSlope;
  const PairVector pairScale = hn::Set(d, state.supportRadius * toWay),
                   support = hn::Set(d, state.supportRadius);
  const auto push = [&state](const auto& centre, std::size_t i)
                        HWY_ATTR { return pushOfPairs<Kernel>(state, centre, i); };
  const auto move = [&](std::size_t first, std::size_t count, const Float4* four,
                        const float* /*fifth*/) HWY_ATTR {
    const Components sums = loadSome(four, kPairs);
    Components at = loadSome(&state.current[first], count);
    at.x = hn::MulAdd(pairScale, sums.x, at.x);
    at.y = hn::MulAdd(pairScale, sums.y, at.y);
    at.z = hn::MulAdd(pairScale, sums.z, at.z);
    if (wallPush) {
      const Vectors wall = gatherAtWalls(state.wallSlot.data(), first, count, [&state](std::size_t i) {
        return Vec3f((state.wallPush(i) - eveningOf(state, i) * state.density[i]) *
                     state.wallSlots[state.wallSlot[i]].sample.pairGradient);
      });
      at.x = hn::NegMulAdd(support, wall.x, at.x);
      at.y = hn::NegMulAdd(support, wall.y, at.y);
      at.z = hn::NegMulAdd(support, wall.z, at.z);
    }
    if (weight != 1) {
      const Components before = loadSome(&state.previous[first], count);
      const PairVector share = hn::Set(d, weight);
      at.x = hn::MulAdd(share, hn::Sub(at.x, before.x), before.x);
      at.y = hn::MulAdd(share, hn::Sub(at.y, before.y), before.y);
      at.z = hn::MulAdd(share, hn::Sub(at.z, before.z), before.z);
    }
    at.w = hn::Zero(d);
    storeSome(at, &state.previous[first], count);
  };
  forBlocks(state.paired.data(), scale, begin, end, push, move);
}

void movePositionsOfRange(StepState& state, float weight, std::size_t begin, std::size_t end) {
  withKernel(state.parameters.kernel,
             [&](auto kernel) HWY_ATTR { moveRange<decltype(kernel)>(state, weight, begin, end); });
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(computeLambdaOfRange);

IterationError stages::computeLambda(StepState& state) {
  const std::size_t n = state.particles.size();
  state.density.resize(n);
  state.lambda.resize(n);
  resizeTight(state.paired, n + 1);
  state.paired[n] = Float4(state.neighbours.ghost().xyz());
  const auto ofRange = HWY_DYNAMIC_DISPATCH(computeLambdaOfRange);
  const ErrorSum error = parallelReduce(
      state.pool, n, ErrorSum{},
      [&](std::size_t begin, std::size_t end) { return ofRange(state, begin, end); },
      [](ErrorSum a, const ErrorSum& b) {
        return ErrorSum{a.sum + b.sum, a.squares + b.squares, std::max(a.max, b.max)};
      });
  const double share = n > 0 ? 1 / static_cast<double>(n) : 0;
  return {n > 0 ? error.sum / static_cast<double>(n) : 0, static_cast<double>(error.max),
          error.squares * share};
}

HWY_EXPORT(movePositionsOfRange);

void stages::movePositions(StepState& state, float weight) {
  const std::size_t n = state.particles.size();
  resizeTight(state.previous, n + 1);
  state.previous[n] = state.current[n];
  const auto ofRange = HWY_DYNAMIC_DISPATCH(movePositionsOfRange);
  parallelFor(state.pool, n,
              [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state, weight, begin, end); });
  state.current.swap(state.previous);
}

}  // namespace migiwa
#endif  // HWY_ONCE
