// Three viscosities. XSPH (Schechter & Bridson 2012, Macklin & Mueller 2013) moves each velocity towards the
// kernel-weighted mean of its neighbours', v_i += c sum_j (m/rho0) (v_j - v_i) W_ij: a smoothing by the step,
// whose strength depends on the spacing and the time step. Affine XSPH does so with what is left of the
// difference when the part is taken off that is linear in space, the neighbours' affine motion:
//
//   v_i += c sum_j (m/rho0) (v_j - v_i - (L_i + L_j)/2 (x_j - x_i)) W_ij
//   L_i = -(m/rho0) sum_j (v_i - v_j) grad W_ij^T B_i,   B_i the inverse moment
//
// so that it damps the noise of single particles and spares translation, rotation, shear and long waves. The
// pairs are antisymmetric: momentum is conserved. The kinematic one is the viscous force with the
// angular momentum conserving pair form of Monaghan (2005), v_i' = nu k/h^2 sum_j w_ij ((v_j - v_i) . e) e
// along the unit vector e between the particles, made implicit in time (Weiler et al. 2018), so that it is
// stable for any time step. Deviation: the rest density in place of rho_j makes the pairs symmetric, so
// momentum is conserved exactly. Walls do not hold the fluid: it slips along them.
#include <cmath>
#include <memory>

#include "core/effects/effects.h"
#include "core/solver/state.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/viscosity.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_VISCOSITY_TYPES
#define MIGIWA_VISCOSITY_TYPES
namespace migiwa {

/// What affine XSPH gathers of a neighbour, in one cache line.
struct alignas(64) AffineMotion {
  Float4 place;    ///< (m)
  Float4 x, y, z;  ///< rows of half the velocity gradient (1/s), the velocity in w (m/s)
};

/// Sums over neighbours: the rows of (v_i - v_j) grad W^T, the moment's diagonal in w; the moment's rest.
struct GradientSums {
  Float4 x, y, z, rest;
};

}  // namespace migiwa
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// What forPairs() does with the sums of a particle: its velocity becomes that of `before` and `scale` times
/// them.
HWY_INLINE auto addSums(StepState& state, const Float4* before, float scale) {
  return [&state, before, scale](std::size_t i, const Float4& sums)
             HWY_ATTR { state.particles.velocity[i] = Float4(Vec3f(before[i].xyz() + scale * sums.xyz())); };
}

/// `before`: the velocities, with the ghost's.
template <class Kernel>
void smoothRange(StepState& state, const Float4* before, float scale, std::size_t begin, std::size_t end) {
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const Float4 velocity = before[i];
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector vx = hn::Set(d, velocity.x), vy = hn::Set(d, velocity.y), vz = hn::Set(d, velocity.z);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      const Components others = loadComponents(before, &list[k]);
      const PairVector shape = KernelVectors<Kernel>::shape(d, r);
      x = hn::MulAdd(shape, hn::Sub(others.x, vx), x);
      y = hn::MulAdd(shape, hn::Sub(others.y, vy), y);
      z = hn::MulAdd(shape, hn::Sub(others.z, vz), z);
    }
    return sumLanes(x, y, z, hn::Zero(d));
  };
  forPairs(positions, pairScale, begin, end, sumOf,
           addSums(state, before, scale * KernelVectors<Kernel>::kValue));
}

/// The motion of the particles; `before`: the velocities, with the ghost's.
template <class Kernel>
void gradientRange(StepState& state, const Float4* before, AffineMotion* motions, std::size_t begin,
                   std::size_t end) {
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const float scale = -state.lattice.massRatio * Pair::kSlope * pairScale.inverseSquare;
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const Float4 velocity = before[i];
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector vx = hn::Set(d, velocity.x), vy = hn::Set(d, velocity.y), vz = hn::Set(d, velocity.z);
    PairVector xx = hn::Zero(d), xy = hn::Zero(d), xz = hn::Zero(d), yx = hn::Zero(d), yy = hn::Zero(d);
    PairVector yz = hn::Zero(d), zx = hn::Zero(d), zy = hn::Zero(d), zz = hn::Zero(d);
    PairVector mxx = hn::Zero(d), myy = hn::Zero(d), mzz = hn::Zero(d);
    PairVector mxy = hn::Zero(d), mxz = hn::Zero(d), myz = hn::Zero(d);
    for (std::size_t first = 0; first < list.size(); first += PairBlock::kMost) {
      const std::size_t last = HWY_MIN(first + PairBlock::kMost, list.size());
      PairBlock block;
      for (std::size_t k = first; k < last; k += kPairs) {
        const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
        const PairVector push = Pair::push(d, distances(d, pair.squared));
        const PairVector x = hn::Mul(push, pair.x), y = hn::Mul(push, pair.y), z = hn::Mul(push, pair.z);
        block.store(k - first, x, y, z);
        mxx = hn::MulAdd(x, pair.x, mxx), myy = hn::MulAdd(y, pair.y, myy), mzz = hn::MulAdd(z, pair.z, mzz);
        mxy = hn::MulAdd(x, pair.y, mxy), mxz = hn::MulAdd(x, pair.z, mxz), myz = hn::MulAdd(y, pair.z, myz);
      }
      for (std::size_t k = first; k < last; k += kPairs) {
        const Components others = loadComponents(before, &list[k]);
        const PairVector x = hn::Load(d, &block.x[k - first]), y = hn::Load(d, &block.y[k - first]);
        const PairVector z = hn::Load(d, &block.z[k - first]);
        const PairVector ux = hn::Sub(vx, others.x), uy = hn::Sub(vy, others.y), uz = hn::Sub(vz, others.z);
        xx = hn::MulAdd(ux, x, xx), xy = hn::MulAdd(ux, y, xy), xz = hn::MulAdd(ux, z, xz);
        yx = hn::MulAdd(uy, x, yx), yy = hn::MulAdd(uy, y, yy), yz = hn::MulAdd(uy, z, yz);
        zx = hn::MulAdd(uz, x, zx), zy = hn::MulAdd(uz, y, zy), zz = hn::MulAdd(uz, z, zz);
      }
    }
    return GradientSums{sumLanes(xx, xy, xz, mxx), sumLanes(yx, yy, yz, myy), sumLanes(zx, zy, zz, mzz),
                        sumLanes(mxy, mxz, myz, hn::Zero(d))};
  };
  for (std::size_t i = begin; i < end; ++i) {
    GradientSums sums = sumOf(PairCentre(positions[i], pairScale), i);
    if (HWY_UNLIKELY(hasCoincident(sums.x)))
      sums = sumOf(PartingCentre{PairCentre(positions[i], pairScale), pairScale, i}, i);
    const InverseMoment inverse(scale * Vec3f(sums.x.w, sums.y.w, sums.z.w), scale * sums.rest.xyz());
    // Of too few neighbours, in spray, nothing is known: plain XSPH.
    const float half = 0.5F * scale;
    const auto row = [&](const Float4& sum, float velocity) {
      return Float4(Vec3f(half * inverse.times(sum.xyz())), velocity);
    };
    const Float4& velocity = before[i];
    motions[i] = {positions[i], row(sums.x, velocity.x), row(sums.y, velocity.y), row(sums.z, velocity.z)};
  }
}

void velocityGradientOfRange(StepState& state, const Float4* before, AffineMotion* motions, std::size_t begin,
                             std::size_t end) {
  withKernel(state.parameters.kernel, [&](auto kernel) HWY_ATTR {
    gradientRange<decltype(kernel)>(state, before, motions, begin, end);
  });
}

/// What the neighbours' affine motion leaves of a component of the velocity difference, but for the part of
/// the particle's own gradient. An offset points from the neighbour to the particle.
HWY_INLINE PairVector leftOf(const Components& row, const PairOffsets& pair, PairVector velocity) {
  return hn::MulAdd(row.x, pair.x,
                    hn::MulAdd(row.y, pair.y, hn::MulAdd(row.z, pair.z, hn::Sub(row.w, velocity))));
}

template <class Kernel>
void smoothAffineRange(StepState& state, const AffineMotion* motions, float scale, std::size_t begin,
                       std::size_t end) {
  constexpr std::size_t kEach = sizeof(AffineMotion) / sizeof(Float4);
  const PairScale pairScale(state);
  const float toChange = scale * KernelVectors<Kernel>::kValue;
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const AffineMotion& own = motions[i];
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector vx = hn::Set(d, own.x.w), vy = hn::Set(d, own.y.w), vz = hn::Set(d, own.z.w);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    PairVector wayX = hn::Zero(d), wayY = hn::Zero(d), wayZ = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents<kEach>(&motions->place, &list[k]), &list[k]);
      const PairVector shape = KernelVectors<Kernel>::shape(d, distances(d, pair.squared));
      const Components rowX = loadComponents<kEach>(&motions->x, &list[k]);
      x = hn::MulAdd(shape, leftOf(rowX, pair, vx), x);
      const Components rowY = loadComponents<kEach>(&motions->y, &list[k]);
      y = hn::MulAdd(shape, leftOf(rowY, pair, vy), y);
      const Components rowZ = loadComponents<kEach>(&motions->z, &list[k]);
      z = hn::MulAdd(shape, leftOf(rowZ, pair, vz), z);
      wayX = hn::MulAdd(shape, pair.x, wayX);
      wayY = hn::MulAdd(shape, pair.y, wayY);
      wayZ = hn::MulAdd(shape, pair.z, wayZ);
    }
    const Vec3f way = sumLanes(wayX, wayY, wayZ, hn::Zero(d)).xyz();
    const Vec3f ofOwn(own.x.xyz().dot(way), own.y.xyz().dot(way), own.z.xyz().dot(way));
    return Float4(Vec3f(sumLanes(x, y, z, hn::Zero(d)).xyz() + ofOwn));
  };
  const auto use = [&](std::size_t i, const Float4& sums) HWY_ATTR {
    const Vec3f before(motions[i].x.w, motions[i].y.w, motions[i].z.w);
    state.particles.velocity[i] = Float4(Vec3f(before + toChange * sums.xyz()));
  };
  forPairs(state.current.data(), pairScale, begin, end, sumOf, use);
}

void smoothAffineOfRange(StepState& state, const AffineMotion* motions, float scale, std::size_t begin,
                         std::size_t end) {
  withKernel(state.parameters.kernel, [&](auto kernel) HWY_ATTR {
    smoothAffineRange<decltype(kernel)>(state, motions, scale, begin, end);
  });
}

void smoothVelocitiesOfRange(StepState& state, const Float4* before, float scale, std::size_t begin,
                             std::size_t end) {
  withKernel(state.parameters.kernel,
             [&](auto kernel) HWY_ATTR { smoothRange<decltype(kernel)>(state, before, scale, begin, end); });
}

/// The sum over the neighbours of w ((v_i - v_j) . e) e, times `scale`. `velocities` end with the ghost's.
void shearOfRange(const StepState& state, const Float4* velocities, Float4* out, float scale,
                  std::size_t begin, std::size_t end) {
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const Float4 velocity = velocities[i];
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector one = hn::Set(d, 1.0F);
    const PairVector vx = hn::Set(d, velocity.x), vy = hn::Set(d, velocity.y), vz = hn::Set(d, velocity.z);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      const Components others = loadComponents(velocities, &list[k]);
      // kShearWeight of q, over q^2.
      const PairVector t = hn::Sub(one, r.q2), weight = hn::Div(hn::Mul(t, t), r.q2);
      const PairVector along =
          hn::MulAdd(hn::Sub(vx, others.x), pair.x,
                     hn::MulAdd(hn::Sub(vy, others.y), pair.y, hn::Mul(hn::Sub(vz, others.z), pair.z)));
      const PairVector force = hn::Mul(weight, along);
      x = hn::MulAdd(force, pair.x, x), y = hn::MulAdd(force, pair.y, y), z = hn::MulAdd(force, pair.z, z);
    }
    return sumLanes(x, y, z, hn::Zero(d));
  };
  const auto use = [&](std::size_t i, const Float4& sums)
                       HWY_ATTR { out[i] = Float4(Vec3f(scale * pairScale.inverseSquare * sums.xyz())); };
  forPairs(positions, pairScale, begin, end, sumOf, use);
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(smoothVelocitiesOfRange);
HWY_EXPORT(velocityGradientOfRange);
HWY_EXPORT(smoothAffineOfRange);
HWY_EXPORT(shearOfRange);

namespace {

/// The weight w of a pair, as written out in shearOfRange: of the simple ones, the one whose shear resistance
/// on a cubic lattice depends least on the direction.
constexpr auto kShearWeight = [](double q) { return q < 1 ? (1 - q * q) * (1 - q * q) : 0.0; };

double dot(const Float4& a, const Float4& b) {
  return static_cast<double>(a.x) * static_cast<double>(b.x) +
         static_cast<double>(a.y) * static_cast<double>(b.y) +
         static_cast<double>(a.z) * static_cast<double>(b.z);
}

Float4 sum(const Float4& a, float factor, const Float4& b) {
  return Float4(Vec3f(a.xyz() + factor * b.xyz()));
}

/// Conjugate gradients on (1 + dt L) v = v0, L the viscous operator. Every iterate keeps the momentum of v0.
class ImplicitShear {
 public:
  /// `scale`: what the sum over the neighbours is multiplied by. `residual`: memory for the solve.
  ImplicitShear(StepState& state, float scale, EffectBuffer& residual)
      : state_(state), scale_(scale), residual_(residual), direction_(state.paired), image_(state.previous) {
    const std::size_t n = state.particles.size();
    resizeTight(residual_, n);
    resizeTight(direction_, n + 1);
    resizeTight(image_, n + 1);
    direction_[n] = Float4();
  }

  void run() {
    // The change that an explicit step would make sets the scale; a thousandth of it is negligible.
    constexpr double kTolerance = 1e-3;
    constexpr int kMostIterations = 1000;
    const auto v = [&](std::size_t i) -> Float4& { return state_.particles.velocity[i]; };
    parallelEach(state_.pool, state_.particles.size(),
                 [&](std::size_t i) { direction_[i] = Float4(v(i).xyz()); });
    image();
    parallelEach(state_.pool, state_.particles.size(),
                 [&](std::size_t i) { direction_[i] = residual_[i] = Float4(Vec3f(-image_[i].xyz())); });
    double square = parallelSum(state_.pool, state_.particles.size(),
                                [&](std::size_t i) { return dot(residual_[i], residual_[i]); });
    const double enough = kTolerance * kTolerance * square;
    for (int iteration = 0; iteration < kMostIterations && square > enough; ++iteration) {
      image();
      parallelEach(state_.pool, state_.particles.size(),
                   [&](std::size_t i) { image_[i] = sum(image_[i], 1, direction_[i]); });
      const double curvature = parallelSum(state_.pool, state_.particles.size(),
                                           [&](std::size_t i) { return dot(direction_[i], image_[i]); });
      const auto along = static_cast<float>(square / curvature);
      parallelEach(state_.pool, state_.particles.size(), [&](std::size_t i) {
        v(i) = sum(v(i), along, direction_[i]);
        residual_[i] = sum(residual_[i], -along, image_[i]);
      });
      const double before = square;
      square = parallelSum(state_.pool, state_.particles.size(),
                           [&](std::size_t i) { return dot(residual_[i], residual_[i]); });
      const auto keep = static_cast<float>(square / before);
      parallelEach(state_.pool, state_.particles.size(),
                   [&](std::size_t i) { direction_[i] = sum(residual_[i], keep, direction_[i]); });
    }
  }

 private:
  /// image = dt L direction.
  void image() {
    const auto ofRange = HWY_DYNAMIC_DISPATCH(shearOfRange);
    parallelFor(state_.pool, state_.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      ofRange(state_, direction_.data(), image_.data(), scale_, begin, end);
    });
  }

  StepState& state_;
  float scale_;
  EffectBuffer &residual_, &direction_, &image_;
};

class Viscosity final : public EffectOf<Viscosity> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.number("xsph", self.xsph_, Range::closed(0, 1),
                   {"1", "Part of the velocity difference to the neighbours that a step takes away."});
    visitor.number(
        "affine_xsph", self.affine_, Range::closed(0, 1),
        {"1",
         "The same of what the neighbours' affine motion leaves of the difference: it damps noise and "
         "spares rotation, shear and waves."});
    visitor.number(
        "kinematic", self.kinematic_, Range::closed(0, 1e3),
        {"m^2/s", "Kinematic viscosity: 1e-6 is water, 1e-3 oil, 1e-2 honey. Set xsph to 0 for this alone."});
  }

  EffectStages stages() const override { return {.velocity = xsph_ > 0 || affine_ > 0 || kinematic_ > 0}; }
  std::size_t buffers() const override { return affine_ > 0 || kinematic_ > 0 ? 1 : 0; }

  void changeVelocities(StepState& state, std::span<EffectBuffer> buffers) const override {
    if (xsph_ > 0) smooth(state);
    if (affine_ > 0) smoothAffine(state, buffers);
    if (kinematic_ > 0) {
      // A linear shear is resisted by nu if k sum_j w q^2 = 30 over neighbours in all directions alike. Those
      // of a lattice stand in for those of a flowing fluid, which resist by so much less.
      constexpr double kFlowing = 0.948;
      const double lattice =
          latticeSum(state.parameters.supportRatio, [](double q) { return kShearWeight(q) * q * q; });
      const double rate =
          kinematic_ * 30 / (kFlowing * lattice) /
          (static_cast<double>(state.supportRadius) * static_cast<double>(state.supportRadius));
      ImplicitShear(state, static_cast<float>(static_cast<double>(state.timeStep) * rate), buffers[0]).run();
    }
  }

 private:
  /// A copy of the velocities, with the ghost's.
  static const Float4* copyVelocities(StepState& state) {
    const std::size_t n = state.particles.size();
    std::vector<Float4>& before = state.paired;
    resizeTight(before, n + 1);
    before[n] = Float4();
    parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::copy(&state.particles.velocity[begin], &state.particles.velocity[begin] + (end - begin),
                &before[begin]);
    });
    return before.data();
  }

  void smooth(StepState& state) const {
    const Float4* const before = copyVelocities(state);
    const float scale = static_cast<float>(xsph_) * state.lattice.massRatio;
    const auto ofRange = HWY_DYNAMIC_DISPATCH(smoothVelocitiesOfRange);
    parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      ofRange(state, before, scale, begin, end);
    });
  }

  void smoothAffine(StepState& state, std::span<EffectBuffer> buffers) const {
    const std::size_t n = state.particles.size();
    constexpr std::size_t kEach = sizeof(AffineMotion) / sizeof(Float4);
    EffectBuffer& memory = buffers[0];
    resizeTight(memory, kEach * (n + 2));  // one more, for what is not aligned
    void* start = memory.data();
    std::size_t bytes = memory.size() * sizeof(Float4);
    auto* const motions = static_cast<AffineMotion*>(
        std::align(alignof(AffineMotion), (n + 1) * sizeof(AffineMotion), start, bytes));
    motions[n] = {state.current[n], Float4(), Float4(), Float4()};
    const Float4* const before = copyVelocities(state);
    const auto gradient = HWY_DYNAMIC_DISPATCH(velocityGradientOfRange);
    const auto smoothed = HWY_DYNAMIC_DISPATCH(smoothAffineOfRange);
    parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      gradient(state, before, motions, begin, end);
    });
    const float scale = static_cast<float>(affine_) * state.lattice.massRatio;
    parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      smoothed(state, motions, scale, begin, end);
    });
  }

  double xsph_ = 0.05;
  double affine_ = 0;
  double kinematic_ = 0;
};

}  // namespace

std::unique_ptr<Effect> makeViscosity() {
  return std::make_unique<Viscosity>();
}

}  // namespace migiwa
#endif  // HWY_ONCE
