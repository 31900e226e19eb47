#include <algorithm>

#include "core/solver/press.h"
#include "core/solver/step.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/press_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_PRESS_HELPERS
#define MIGIWA_PRESS_HELPERS
namespace migiwa::press {

/// What the wall takes off the gradient of the density of particle i, which has a wall slot: s grad g, or
/// grad g where its density is added (1/m).
inline Vec3f wallGradient(const StepState& state, std::size_t i, float density) {
  const float fall = (state.addsWallDensity() ? 1 : density) * state.densityGammaSlope(state.gamma[i]);
  return fall / state.supportRadius * state.wallSlots[state.wallSlot[i]].sample.pairGradient;
}

}  // namespace migiwa::press
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

template <class Kernel>
void measurePressRange(StepState& state, std::size_t begin, std::size_t end) {
  using Shape = KernelVectors<Kernel>;
  const Pairs d;
  const PairScale scale(state);
  const Float4* const positions = state.current.data();
  const PairVector toFactor = hn::Set(d, state.lattice.massRatio * Shape::kSlope * scale.inverseSquare);
  const float support2 = state.supportRadius * state.supportRadius;
  const bool added = state.addsWallDensity();
  state.neighbours.makePairValues(begin / kChunk);
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    PairVector covered = hn::Zero(d), squares = hn::Zero(d);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    float* const HWY_RESTRICT factors = state.neighbours.pairValues(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      covered = hn::Add(covered, Shape::shape(d, r));
      const PairVector factor = hn::Mul(toFactor, Shape::push(d, r));
      hn::Store(factor, d, &factors[k]);
      squares = hn::MulAdd(hn::Mul(factor, factor), r.q2, squares);
      x = hn::MulAdd(factor, pair.x, x), y = hn::MulAdd(factor, pair.y, y), z = hn::MulAdd(factor, pair.z, z);
    }
    const Float4 sums = sumLanes(x, y, z, covered);
    const float resting = state.densityGamma(state.gamma[i]);
    const float uncorrected = state.lattice.massRatio * (Shape::kValue * sums.w + Kernel::value(0));
    const float density = correctedDensity(uncorrected, resting, added);
    Vec3f gradient = sums.xyz();
    if (state.wallSlot[i] != FluidState::kNoWall) gradient -= press::wallGradient(state, i, density);
    const float inverse = added ? 1 : 1 / resting;
    state.density[i] = density;
    state.projection.diagonal[i] =
        inverse * inverse * (gradient.squaredNorm() + support2 * sumLanes(squares));
  }
}

void measurePressOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withOwnGradient(state.parameters.kernel,
                  [&](auto kernel) HWY_ATTR { measurePressRange<decltype(kernel)>(state, begin, end); });
}

/// state.paired: places, and in w what w_i adds to velocities in the step (m^2/s); state.previous:
/// velocities.
template <bool kViscous>
void pushPressRange(StepState& state, float viscosity, std::size_t begin, std::size_t end) {
  const Pairs d;
  const PairScale scale(state);
  const Float4* const others = state.paired.data();
  const Float4* const velocities = state.previous.data();
  constexpr float kLeast = 0.0025F;  // of the squared support, 0.01 of that of half the support
  const PairVector least = hn::Set(d, kLeast * state.supportRadius * state.supportRadius);
  const PairVector viscous = hn::Set(d, viscosity * state.timeStep), zero = hn::Zero(d);
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(others[i], scale);
    const Vec3f own = velocities[i].xyz();
    const PairVector w = hn::Set(d, others[i].w);
    const PairVector ux = hn::Set(d, own.x()), uy = hn::Set(d, own.y()), uz = hn::Set(d, own.z());
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const float* const HWY_RESTRICT factors = state.neighbours.pairValues(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const Components neighbours = loadComponents(others, &list[k]);
      const PairOffsets pair = centre.to(neighbours, &list[k]);
      PairVector push = hn::Add(w, neighbours.w);
      if constexpr (kViscous) {
        const Components v = loadComponents(velocities, &list[k]);
        const PairVector along =
            hn::MulAdd(hn::Sub(ux, v.x), pair.x,
                       hn::MulAdd(hn::Sub(uy, v.y), pair.y, hn::Mul(hn::Sub(uz, v.z), pair.z)));
        const PairVector square =
            hn::MulAdd(pair.x, pair.x, hn::MulAdd(pair.y, pair.y, hn::MulAdd(pair.z, pair.z, least)));
        push = hn::Sub(push, hn::Mul(viscous, hn::Div(hn::Min(along, zero), square)));
      }
      push = hn::Mul(push, hn::Load(d, &factors[k]));
      x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
    }
    Vec3f velocity = own - sumLanes(x, y, z, hn::Zero(d)).xyz();
    if (state.wallSlot[i] != FluidState::kNoWall)
      velocity += others[i].w * press::wallGradient(state, i, state.density[i]);
    state.projection.velocity[i] = Float4(velocity);
  }
}

void pushPressOfRange(StepState& state, float viscosity, std::size_t begin, std::size_t end) {
  if (viscosity > 0) return pushPressRange<true>(state, viscosity, begin, end);
  pushPressRange<false>(state, viscosity, begin, end);
}

template <class Kernel>
void pressDensityRange(StepState& state, std::size_t begin, std::size_t end) {
  using Shape = KernelVectors<Kernel>;
  const Pairs d;
  const PairScale scale(state);
  const Float4* const positions = state.current.data();
  const bool added = state.addsWallDensity();
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    PairVector covered = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      covered = hn::Add(covered, Shape::shape(d, distances(d, pair.squared)));
    }
    const float resting = state.densityGamma(state.gamma[i]);
    const float uncorrected =
        state.lattice.massRatio * (Shape::kValue * sumLanes(covered) + Kernel::value(0));
    state.density[i] = correctedDensity(uncorrected, resting, added);
  }
}

void pressDensityOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withOwnGradient(state.parameters.kernel,
                  [&](auto kernel) HWY_ATTR { pressDensityRange<decltype(kernel)>(state, begin, end); });
}

void pressRateOfRange(StepState& state, std::size_t begin, std::size_t end) {
  const Pairs d;
  const PairScale scale(state);
  const Float4* const positions = state.current.data();
  const Float4* const velocities = state.projection.velocity.data();
  const bool added = state.addsWallDensity();
  for (std::size_t i = begin; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    const Vec3f own = velocities[i].xyz();
    const PairVector ux = hn::Set(d, own.x()), uy = hn::Set(d, own.y()), uz = hn::Set(d, own.z());
    PairVector sum = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const float* const HWY_RESTRICT factors = state.neighbours.pairValues(i);
    prefetchLists(list.data());
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Components v = loadComponents(velocities, &list[k]);
      const PairVector along = hn::MulAdd(
          hn::Sub(ux, v.x), pair.x, hn::MulAdd(hn::Sub(uy, v.y), pair.y, hn::Mul(hn::Sub(uz, v.z), pair.z)));
      sum = hn::MulAdd(hn::Load(d, &factors[k]), along, sum);
    }
    float rate = sumLanes(sum);
    if (state.wallSlot[i] != FluidState::kNoWall) {
      const Vec3f relative = own - state.boundary.wallVelocity(positions[i].xyz());
      rate -= press::wallGradient(state, i, state.density[i]).dot(relative);
    }
    state.projection.residual[i] = added ? rate : rate / state.densityGamma(state.gamma[i]);
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(measurePressOfRange);
HWY_EXPORT(pushPressOfRange);
HWY_EXPORT(pressDensityOfRange);
HWY_EXPORT(pressRateOfRange);

namespace {

/// What w_i of particle i adds to velocities in the step (m^2/s).
float multiplier(const StepState& state, std::size_t i) {
  const float density = state.density[i];
  const float resting = state.addsWallDensity() ? 1 : state.densityGamma(state.gamma[i]);
  return state.timeStep * state.projectedPressure[i] / (density * density * resting);
}

/// Of the density that is there, after no iteration.
IterationError densityError(const StepState& state) {
  const std::size_t n = state.particles.size();
  const IterationError sums = parallelReduce(
      state.pool, n, IterationError{},
      [&](std::size_t begin, std::size_t end) {
        IterationError part;
        for (std::size_t i = begin; i < end; ++i) {
          const auto error = static_cast<double>(std::max(state.density[i] - 1, 0.0F));
          part.mean += error, part.meanSquare += error * error, part.max = std::max(part.max, error);
        }
        return part;
      },
      [](const IterationError& a, const IterationError& b) {
        return IterationError{a.mean + b.mean, std::max(a.max, b.max), a.meanSquare + b.meanSquare};
      });
  const double share = n > 0 ? 1 / static_cast<double>(n) : 0;
  return {share * sums.mean, sums.max, share * sums.meanSquare};
}

}  // namespace

IterationError press::measure(StepState& state) {
  const std::size_t n = state.particles.size();
  ProjectionBuffers& buffers = state.projection;
  buffers.diagonal.resize(n);
  state.density.resize(n);
  state.lambda.resize(n);
  resizeTight(state.previous, n + 1);
  resizeTight(state.paired, n + 1);
  resizeTight(buffers.velocity, n + 1);
  state.paired[n] = Float4(state.neighbours.ghost().xyz());
  state.previous[n] = buffers.velocity[n] = Float4();
  std::copy_n(state.particles.velocity.begin(), n, state.previous.begin());
  std::copy_n(state.particles.velocity.begin(), n, buffers.velocity.begin());
  const auto ofRange = HWY_DYNAMIC_DISPATCH(measurePressOfRange);
  parallelFor(state.pool, n,
              [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state, begin, end); });
  return densityError(state);
}

void press::push(StepState& state, float viscosity) {
  const std::size_t n = state.particles.size();
  parallelEach(state.pool, n, [&](std::size_t i) {
    state.paired[i] = Float4(state.particles.position[i].xyz(), multiplier(state, i));
  });
  const auto ofRange = HWY_DYNAMIC_DISPATCH(pushPressOfRange);
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    ofRange(state, viscosity, begin, end);
  });
}

IterationError press::predictDensity(StepState& state) {
  parallelEach(state.pool, state.particles.size(), [&](std::size_t i) {
    const Vec3f way = state.timeStep * state.projection.velocity[i].xyz();
    state.current[i] = Float4(Vec3f(state.particles.position[i].xyz() + way));
  });
  if (!state.boundary.empty()) stages::refreshGamma(state);
  const auto ofRange = HWY_DYNAMIC_DISPATCH(pressDensityOfRange);
  parallelFor(state.pool, state.particles.size(),
              [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state, begin, end); });
  return densityError(state);
}

void press::rate(StepState& state) {
  state.projection.residual.resize(state.particles.size());
  const auto ofRange = HWY_DYNAMIC_DISPATCH(pressRateOfRange);
  parallelFor(state.pool, state.particles.size(),
              [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state, begin, end); });
}

float press::stiffness(const StepState& state, float squares) {
  const float full = state.lattice.squaredGradients / (state.supportRadius * state.supportRadius);
  return 1 / (state.timeStep * state.timeStep * (squares + full));
}

void press::take(StepState& state) {
  const std::size_t n = state.particles.size();
  const float toLambda = state.timeStep * state.timeStep / (state.supportRadius * state.supportRadius);
  parallelEach(state.pool, n, [&](std::size_t i) {
    state.particles.velocity[i] = state.projection.velocity[i];
    state.lambda[i] = -toLambda * state.projectedPressure[i] / (state.density[i] * state.density[i]);
  });
}

void press::bookWork(StepState& state) {
  if (!state.boundary.moves()) return;
  state.wallWork.add(parallelSum(state.pool, state.wallSlots.size(), [&](std::size_t k) {
    const WallSlot& slot = state.wallSlots[k];
    const std::size_t i = slot.particle;
    const Vec3f way = state.timeStep * multiplier(state, i) * press::wallGradient(state, i, state.density[i]);
    return static_cast<double>(way.dot(state.boundary.wallVelocity(slot.at.xyz())));
  }));
}

}  // namespace migiwa
#endif  // HWY_ONCE
