// gamma by fixed directions: the mass of the kernel up to the first hit of each ray with any wall, averaged,
//   gamma = mean G(g_k / h),   h grad gamma = 4 pi mean [H(g_k / h) - H(1)] w_k,
// and, behind a block that a ray has passed, what is fluid again: [FM] Eq. 7 with a g of every direction, for
// any shape of wall and any number of them. Where every wall in reach is made of planes, the closed form of
// the nearest plane takes the place of its own part of the sum: exact on one plane, and half the mean error
// near edges. On curved walls that would be worse than leaving it.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/boundary/gamma/gamma_methods.h"
#include "core/boundary/plane_hits.h"
#include "core/sph/kernels.h"
#include "core/sph/radial_integrals.h"

namespace migiwa {

namespace {

/// Four floats, a vector of the compiler's: every x86-64 has it, so the order of summation is the same
/// everywhere.
using Lanes = float __attribute__((vector_size(16)));
constexpr std::size_t kLanes = 4;

Lanes load(const float* values) {
  Lanes lanes;
  std::memcpy(&lanes, values, sizeof lanes);
  return lanes;
}

float total(const Lanes& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/// Sums over directions: of the mass, and of the slopes of the density and the pair kernel times the
/// direction.
struct RaySums {
  Lanes mass{}, x{}, y{}, z{}, pairX{}, pairY{}, pairZ{};
};

template <class Kernel>
class DirectionsGamma final : public GammaMethod {
 public:
  explicit DirectionsGamma(const GammaContext& context)
      : boundary_(context.boundary),
        support_(context.supportRadius),
        // Whole groups of lanes: no loop needs a tail.
        directions_(fibonacciDirections((context.directions + 3) / 4 * 4)) {}

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    Scratch scratch;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      Vec3f normal;
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p, normal);
      if (out[i].distance >= support_) continue;
      // Rays start in the fluid: a point behind a wall is taken at the wall and gamma continued linearly.
      const float behind = std::min(out[i].distance, 0.0F);
      atFluidPoint(p - behind * normal, std::max(out[i].distance, 0.0F), normal, scratch, out[i]);
      if (behind < 0) {
        const float moved = behind / support_;
        out[i].gamma = std::clamp(out[i].gamma + moved * out[i].gradient.dot(normal), 0.0F, 1.0F);
      }
    }
  }

 private:
  using Pair = PairKernel<Kernel>;

  struct Scratch {
    std::vector<float> hits, enter, leave;
  };

  void atFluidPoint(const Vec3f& p, float distance, const Vec3f& normal, Scratch& scratch,
                    GammaSample& sample) const {
    const std::size_t count = directions_.size();
    std::vector<float>& hits = scratch.hits;
    hits.assign(count, support_);
    bool planar = true;
    for (const auto& surface : boundary_.surfaces()) {
      Vec3f ignored;
      if (surface->distance(p, ignored) >= support_) continue;
      planar = planar && surface->planar();
      if (!surface->reentrant()) surface->firstHits(p, directions_, hits);
    }
    RaySums sums;
    addRays<1>(hits, sums);
    for (const auto& surface : boundary_.surfaces()) {
      Vec3f ignored;
      if (!surface->reentrant() || surface->distance(p, ignored) >= support_) continue;
      // The rays' way through the block is taken out; behind it they go on up to the tank's wall.
      scratch.enter = hits;
      scratch.leave.resize(count);
      surface->firstHits(p, directions_, scratch.enter);
      surface->exits(p, directions_, scratch.leave);
      for (std::size_t k = 0; k < count; ++k)
        scratch.leave[k] = scratch.enter[k] < hits[k] ? std::min(scratch.leave[k], hits[k]) : hits[k];
      addRays<1>(scratch.enter, sums);
      addRays<-1>(scratch.leave, sums);
    }
    float gamma = 0;
    Vec3f gradient = Vec3f::Zero(), pairGradient = Vec3f::Zero();
    if (planar) {
      hits.assign(count, support_);
      hitPlane(normal, distance, directions_, hits);
      addRays<-1>(hits, sums);
      const float e = distance / support_;
      gamma = Kernel::planeGamma(e);
      gradient = Kernel::planeGammaSlope(e) * normal;
      pairGradient = Pair::planeGammaSlope(e) * normal;
    }
    const float mean = 1 / static_cast<float>(count);
    const float scale = 4 * kernel_detail::kPi * mean;
    sample.gamma = std::clamp(gamma + mean * total(sums.mass), 0.0F, 1.0F);
    sample.gradient = gradient + scale * Vec3f(total(sums.x), total(sums.y), total(sums.z));
    sample.pairGradient =
        pairGradient + scale * Vec3f(total(sums.pairX), total(sums.pairY), total(sums.pairZ));
  }

  template <int Sign>
  void addRays(const std::vector<float>& hits, RaySums& sums) const {
    const float inverseSupport = 1 / support_;
    const float full = RadialIntegrals<Kernel>::slope(1.0F), pairFull = RadialIntegrals<Pair>::slope(1.0F);
    RaySums local = sums;
    for (std::size_t k = 0; k < hits.size(); k += kLanes) {
      const Lanes scaled = load(&hits[k]) * inverseSupport;
      const Lanes r = scaled < 1.0F ? scaled : Lanes{} + 1.0F;
      const Lanes x = load(&directions_.x[k]), y = load(&directions_.y[k]), z = load(&directions_.z[k]);
      const Lanes slope = static_cast<float>(Sign) * (RadialIntegrals<Kernel>::slope(r) - full);
      const Lanes pairSlope = static_cast<float>(Sign) * (RadialIntegrals<Pair>::slope(r) - pairFull);
      local.mass += static_cast<float>(Sign) * RadialIntegrals<Kernel>::mass(r);
      local.x += slope * x, local.y += slope * y, local.z += slope * z;
      local.pairX += pairSlope * x, local.pairY += pairSlope * y, local.pairZ += pairSlope * z;
    }
    sums = local;
  }

  const Boundary& boundary_;
  float support_;
  Directions directions_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeDirectionsGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<DirectionsGamma<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
