// Vorticity confinement (Fedkiw, Stam & Jensen 2001, Macklin & Mueller 2013 Eqs. 15 and 16): the swirl that
// the solver smooths away is put back by a force about the places of largest vorticity w = curl v,
// a = strength h (N x w), N = grad |w| / |grad |w||. Deviations: gradients are taken from differences to the
// neighbours and measured by those of the resting lattice; and the net force and torque on all of the fluid
// are taken out as a motion of a rigid body, so that momentum and angular momentum stay what they are.
#include "core/effects/effects.h"
#include "core/solver/state.h"
#include "core/sph/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/vorticity_confinement.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

template <class Vector>
Vector cross(const Vector& a, const Vector& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// w (xyz) and its length (w) from the velocities in `velocities`, which end with the ghost's; the gradient
/// of a linear field comes out of the sums times `scale`.
template <class Kernel>
void curlRange(const StepState& state, const Float4* velocities, Float4* out, float scale, std::size_t begin,
               std::size_t end) {
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const Float4 own = velocities[i];
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector vx = hn::Set(d, own.x), vy = hn::Set(d, own.y), vz = hn::Set(d, own.z);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const PairVector push = Pair::push(d, distances(d, pair.squared));
      const Components others = loadComponents(velocities, &list[k]);
      const PairVector ux = hn::Mul(push, hn::Sub(others.x, vx)), uy = hn::Mul(push, hn::Sub(others.y, vy)),
                       uz = hn::Mul(push, hn::Sub(others.z, vz));
      x = hn::Add(x, hn::Sub(hn::Mul(pair.y, uz), hn::Mul(pair.z, uy)));
      y = hn::Add(y, hn::Sub(hn::Mul(pair.z, ux), hn::Mul(pair.x, uz)));
      z = hn::Add(z, hn::Sub(hn::Mul(pair.x, uy), hn::Mul(pair.y, ux)));
    }
    return sumLanes(x, y, z, hn::Zero(d));
  };
  const auto use = [&](std::size_t i, const Float4& sums) HWY_ATTR {
    const Vec3f curl = scale * Pair::kSlope * sums.xyz();
    out[i] = Float4(curl, curl.norm());
  };
  forPairs(positions, pairScale, begin, end, sumOf, use);
}

/// N x w of the vorticities, which end with the ghost's.
template <class Kernel>
void confineRange(const StepState& state, const Float4* vorticity, Float4* out, float scale,
                  std::size_t begin, std::size_t end) {
  // A gradient that is a small part of w over the support radius has no defined direction.
  constexpr float kFlat = 0.05F;
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector own = hn::Set(d, vorticity[i].w);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const PairVector push = Pair::push(d, distances(d, pair.squared));
      const PairVector rise = hn::Mul(push, hn::Sub(loadComponents(vorticity, &list[k]).w, own));
      x = hn::MulAdd(rise, pair.x, x), y = hn::MulAdd(rise, pair.y, y), z = hn::MulAdd(rise, pair.z, z);
    }
    return sumLanes(x, y, z, hn::Zero(d));
  };
  const auto use = [&](std::size_t i, const Float4& sums) HWY_ATTR {
    const Vec3f gradient = scale * Pair::kSlope * sums.xyz();
    const float least = kFlat * vorticity[i].w * pairScale.inverseSupport;
    const float length = gradient.norm() + least;
    out[i] = length > 0 ? Float4(Vec3f(cross(gradient, vorticity[i].xyz()) / length)) : Float4();
  };
  forPairs(positions, pairScale, begin, end, sumOf, use);
}

void curlOfRange(const StepState& state, const Float4* velocities, Float4* out, float scale,
                 std::size_t begin, std::size_t end) {
  withKernel(state.parameters.kernel, [&](auto kernel) HWY_ATTR {
    curlRange<decltype(kernel)>(state, velocities, out, scale, begin, end);
  });
}

void confineOfRange(const StepState& state, const Float4* vorticity, Float4* out, float scale,
                    std::size_t begin, std::size_t end) {
  withKernel(state.parameters.kernel, [&](auto kernel) HWY_ATTR {
    confineRange<decltype(kernel)>(state, vorticity, out, scale, begin, end);
  });
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(curlOfRange);
HWY_EXPORT(confineOfRange);

namespace {

using HWY_NAMESPACE::cross;

/// Sums over all particles, about the origin.
struct Moments {
  Vec3d place = Vec3d::Zero(), force = Vec3d::Zero(), torque = Vec3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  ///< of places, as outer products

  Moments& operator+=(const Moments& other) {
    place += other.place, force += other.force, torque += other.torque, squares += other.squares;
    return *this;
  }
};

/// The turn w that answers a torque, inertia w = torque, by Cramer's rule.
Vec3d turnBy(const Vec3d& torque, const Eigen::Matrix3d& inertia) {
  constexpr double kLine = 1e-12;
  const Vec3d x = inertia.col(0), y = inertia.col(1), z = inertia.col(2);
  const Vec3d yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const double determinant = x.dot(yz), trace = inertia.trace();
  if (determinant > kLine * trace * trace * trace)
    return Vec3d(torque.dot(yz), torque.dot(zx), torque.dot(xy)) / determinant;
  // Particles in a line do not resist a turn about it, and resist all turns across it alike.
  return trace > 0 ? Vec3d(2 / trace * torque) : Vec3d(Vec3d::Zero());
}

/// Takes from the accelerations those of a rigid body with the same net force and torque.
void removeNetMotion(const StepState& state, std::vector<Float4>& accelerations) {
  const std::size_t n = state.particles.size();
  Moments sums = parallelReduce(
      state.pool, n, Moments{},
      [&](std::size_t begin, std::size_t end) {
        Moments part;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3d x = state.current[i].xyz().cast<double>(), a = accelerations[i].xyz().cast<double>();
          part.place += x, part.force += a, part.torque += cross(x, a), part.squares += x * x.transpose();
        }
        return part;
      },
      [](Moments a, const Moments& b) { return a += b; });
  const double count = static_cast<double>(n);
  const Vec3d centre = sums.place / count, mean = sums.force / count;
  const Vec3d torque = sums.torque - cross(centre, sums.force);
  const Eigen::Matrix3d spread = sums.squares - count * centre * centre.transpose();
  const Eigen::Matrix3d inertia = spread.trace() * Eigen::Matrix3d::Identity() - spread;
  const Vec3d turn = turnBy(torque, inertia);
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d arm = state.current[i].xyz().cast<double>() - centre;
      const Vec3d net = mean + cross(turn, arm);
      accelerations[i].setXyz(accelerations[i].xyz() - net.cast<float>());
    }
  });
}

class VorticityConfinement final : public EffectOf<VorticityConfinement> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.number("strength", self.strength_, Range::closed(0, 100),
                   {"1/s", "Rate at which velocity differences across a support radius are fed."});
  }

  EffectStages stages() const override { return {.velocity = strength_ > 0}; }

  void changeVelocities(StepState& state, std::span<EffectBuffer>) const override {
    const std::size_t n = state.particles.size();
    if (n == 0) return;
    const double slopes = withKernel(state.parameters.kernel, [&](auto kernel) {
      return latticeSum(state.parameters.supportRatio, [](double q) {
        return q * static_cast<double>(PairKernel<decltype(kernel)>::derivative(static_cast<float>(q)));
      });
    });
    const float scale = static_cast<float>(-3 / slopes) / (state.supportRadius * state.supportRadius);
    std::vector<Float4>& velocities = state.paired;
    std::vector<Float4>& vorticity = state.previous;
    resizeTight(velocities, n + 1);
    resizeTight(vorticity, n + 1);
    velocities[n] = vorticity[n] = Float4();
    const auto each = [&](const auto& body) {
      parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) { body(begin, end); });
    };
    each([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) velocities[i] = state.particles.velocity[i];
    });
    const auto curl = HWY_DYNAMIC_DISPATCH(curlOfRange);
    each([&](std::size_t begin, std::size_t end) {
      curl(state, velocities.data(), vorticity.data(), scale, begin, end);
    });
    std::vector<Float4>& directions = state.paired;
    const auto confine = HWY_DYNAMIC_DISPATCH(confineOfRange);
    each([&](std::size_t begin, std::size_t end) {
      confine(state, vorticity.data(), directions.data(), scale, begin, end);
    });
    removeNetMotion(state, directions);
    const float gain = state.timeStep * static_cast<float>(strength_) * state.supportRadius;
    each([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Float4& velocity = state.particles.velocity[i];
        velocity.setXyz(velocity.xyz() + gain * directions[i].xyz());
      }
    });
  }

 private:
  double strength_ = 2;
};

}  // namespace

std::unique_ptr<Effect> makeVorticityConfinement() {
  return std::make_unique<VorticityConfinement>();
}

}  // namespace migiwa
#endif  // HWY_ONCE
