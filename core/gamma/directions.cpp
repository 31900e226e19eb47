// gamma by fixed directions: the mass of the kernel up to the first hit of each ray with any wall, averaged,
//   gamma = mean G(g_k / h),   h grad gamma = 4 pi mean [H(g_k / h) - H(1)] w_k,
// and, behind a thick block that a ray has passed, what is fluid again: [FM] Eq. 7 with a g of every
// direction, for any shape of wall and any number of them. Where every wall in reach is made of planes, the
// closed form of the nearest plane takes the place of its own part of the sum: exact on one plane, and half
// the mean error near edges. On curved walls that would be worse than leaving it.
#include <algorithm>
#include <optional>

#include "core/gamma/batches.h"
#include "core/gamma/gamma_method.h"
#include "core/gamma/half_spaces.h"
#include "core/sph/kernels.h"
#include "core/walls/surface.h"

namespace migiwa {

namespace {

template <class Kernel>
class DirectionsGamma final : public GammaMethod {
 public:
  explicit DirectionsGamma(const GammaContext& context)
      : boundary_(context.boundary),
        kernel_(context.kernel),
        support_(context.supportRadius),
        directions_(groupedDirections(context.directions)),
        flat_(FlatPlanes::of(boundary_, support_)) {}

  void wallsMoved() override { flat_ = FlatPlanes::of(boundary_, support_); }

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
        range_.set(out[i], out[i].gamma + moved * out[i].gradient.dot(normal));
      }
    }
  }

 private:
  using Pair = PairKernel<Kernel>;

  struct Scratch {
    std::vector<HalfSpace> planes;
    std::vector<const Surface*> near;
    std::vector<float> hits, enter, leave;
  };

  void atFluidPoint(const Vec3f& p, float distance, const Vec3f& normal, Scratch& scratch,
                    GammaSample& sample) const {
    if (flat_) {
      flat_->inReach(p, scratch.planes);
      if (scratch.planes.empty()) return;  // at the support radius but for rounding
      std::iter_swap(scratch.planes.begin(),
                     std::min_element(scratch.planes.begin(), scratch.planes.end(),
                                      [](const HalfSpace& a, const HalfSpace& b) { return a.e < b.e; }));
      RaySums rest;
      if (scratch.planes.size() > 1) rest = beyondFirstPlane(kernel_, directions_, scratch.planes);
      return finish(rest, &scratch.planes.front(), sample);
    }

    std::vector<float>& hits = scratch.hits;
    hits.assign(directions_.size(), support_);
    scratch.near.clear();
    bool planar = true;
    for (const Surface* surface : boundary_.near(p, support_)) {
      Vec3f ignored;
      if (surface->distance(p, ignored) >= support_) continue;
      scratch.near.push_back(surface);
      planar = planar && surface->planar();
      if (!surface->passable(support_)) surface->firstHits(p, directions_, hits);
    }
    RaySums sums;
    addRays(kernel_, directions_, hits, support_, 1, sums);
    for (const Surface* surface : scratch.near) {
      if (!surface->passable(support_)) continue;
      // The rays' way through the block is taken out; behind it they go on up to the tank's wall.
      scratch.enter = hits;
      scratch.leave.resize(hits.size());
      surface->firstHits(p, directions_, scratch.enter);
      surface->exits(p, directions_, scratch.leave);
      for (std::size_t k = 0; k < hits.size(); ++k)
        scratch.leave[k] = scratch.enter[k] < hits[k] ? std::min(scratch.leave[k], hits[k]) : hits[k];
      addRays(kernel_, directions_, scratch.enter, support_, 1, sums);
      addRays(kernel_, directions_, scratch.leave, support_, -1, sums);
    }
    if (!planar) return finish(sums, nullptr, sample);
    hits.assign(hits.size(), support_);
    hitPlane(normal, distance, directions_, hits);
    addRays(kernel_, directions_, hits, support_, -1, sums);
    const HalfSpace nearest{normal, distance / support_};
    finish(sums, &nearest, sample);
  }

  /// The sums' means, and the closed form of a plane whose part is not in them.
  void finish(const RaySums& sums, const HalfSpace* plane, GammaSample& sample) const {
    const float mean = 1 / static_cast<float>(directions_.size());
    const float scale = 4 * kernel_detail::kPi * mean;
    sample.gamma = mean * sums.mass;
    sample.gradient = scale * sums.slope;
    sample.pairGradient = scale * sums.pairSlope;
    if (plane != nullptr) {
      sample.gamma += Kernel::planeGamma(plane->e);
      sample.gradient += Kernel::planeGammaSlope(plane->e) * plane->normal;
      sample.pairGradient += Pair::planeGammaSlope(plane->e) * plane->normal;
    }
    range_.set(sample, sample.gamma);
  }

  const Boundary& boundary_;
  KernelType kernel_;
  float support_;
  Directions directions_;
  std::optional<FlatPlanes> flat_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeDirectionsGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<DirectionsGamma<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
