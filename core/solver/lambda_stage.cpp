// METHOD: density [FM] Eq. 5, constraint Eq. 9, its gradients Eqs. 12 and 13 and lambda Eq. 11. Gradients are
// taken from the pair kernel, as in Macklin & Mueller 2013, gamma's included. Deviation: the constraint is
// clamped at zero, for the paper is silent on free surfaces and fluid clumps otherwise. Methods that add the
// walls' density instead of dividing by gamma have C = S + (1 - gamma) - 1, with the gradients that follow.
#include <algorithm>

#include "core/solver/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/lambda_stage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pair_vectors-inl.h"

#ifndef MIGIWA_LAMBDA_STAGE_TYPES
#define MIGIWA_LAMBDA_STAGE_TYPES
namespace migiwa::stages {

struct ErrorSum {
  double sum = 0, squares = 0;
  float max = 0;
};

}  // namespace migiwa::stages
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// What the neighbours of a particle add up to.
struct NeighbourSums {
  float covered;        ///< sum of W, the particle itself left out
  float squaredSlopes;  ///< sum of the squared slopes of the pair kernel
  Vec3f gradient;       ///< sum of the gradients of the pair kernel, times the support radius squared
};

/// Of a pair on one point they are not.
HWY_INLINE bool isFinite(const NeighbourSums& sums) {
  return std::isfinite(sums.squaredSlopes);
}

template <class Kernel, class Centre>
HWY_INLINE NeighbourSums sumNeighbours(const StepState& state, const Centre& centre, std::size_t i) {
  using Density = KernelVectors<Kernel>;
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const Pairs d;
  const Float4* const others = state.current.data();
  PairVector covered = hn::Zero(d), slopes = hn::Zero(d), x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
  const std::span<const std::uint32_t> list = state.neighbours.groups(i);
  prefetchLists(list.data());
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const PairOffsets pair = centre.to(loadComponents(others, &list[k]), &list[k]);
    const Distances<PairVector> r = distances(d, pair.squared);
    covered = hn::Add(covered, Density::value(d, r));
    const PairVector slope = Pair::slopeOverDistance(d, r);
    slopes = hn::MulAdd(hn::Mul(slope, slope), r.q2, slopes);
    x = hn::MulAdd(slope, pair.x, x), y = hn::MulAdd(slope, pair.y, y), z = hn::MulAdd(slope, pair.z, z);
  }
  const Float4 sums = sumLanes(x, y, z, covered);
  return {sums.w, hn::GetLane(hn::SumOfLanes(d, slopes)), sums.xyz()};
}

template <class Kernel>
stages::ErrorSum lambdaOfRange(StepState& state, std::size_t begin, std::size_t end) {
  const float massRatio = state.lattice.massRatio;
  const float epsilon = static_cast<float>(state.parameters.cfmEpsilon) * state.lattice.squaredGradients;
  const bool divideByGamma = state.parameters.positionStep == PositionStep::gradient;
  const bool added = state.addsWallDensity();
  const PairScale scale(state);
  const auto ofNeighbours = [&state](const auto& centre, std::size_t i)
                                HWY_ATTR { return sumNeighbours<Kernel>(state, centre, i); };
  stages::ErrorSum error;
  const auto solve = [&](std::size_t i, const NeighbourSums& sums) HWY_ATTR {
    const float inverseGamma = added ? 1 : 1 / state.gamma[i];
    float density = massRatio * (Kernel::value(0) + sums.covered) * inverseGamma;
    if (added) density += 1 - state.gamma[i];
    const float constraint = std::max(density - 1, 0.0F);
    float lambda = 0;
    if (constraint > 0) {
      Vec3f gradient = massRatio * (scale.inverseSupport * sums.gradient);
      if (const std::uint32_t slot = state.wallSlot[i]; slot != StepState::kNoWall)
        gradient -= (added ? 1 : density) * state.wallSlots[slot].sample.pairGradient;
      const float squaredGradients =
          (gradient.squaredNorm() + massRatio * massRatio * sums.squaredSlopes) * inverseGamma * inverseGamma;
      lambda = -constraint / (squaredGradients + epsilon);
    }
    state.density[i] = density;
    state.lambda[i] = lambda;
    state.paired[i] = Float4(state.current[i].xyz(), divideByGamma ? lambda * inverseGamma : lambda);
    error.sum += static_cast<double>(constraint);
    error.squares += static_cast<double>(constraint * constraint);
    error.max = std::max(error.max, constraint);
  };
  forPairs(state.current.data(), scale, begin, end, ofNeighbours, solve);
  return error;
}

stages::ErrorSum computeLambdaOfRange(StepState& state, std::size_t begin, std::size_t end) {
  return withKernel(state.parameters.kernel,
                    [&](auto kernel) HWY_ATTR { return lambdaOfRange<decltype(kernel)>(state, begin, end); });
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

}  // namespace migiwa
#endif  // HWY_ONCE
