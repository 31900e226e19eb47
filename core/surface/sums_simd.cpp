// The sum of all kernels at the nodes of a block, a row of nodes at a time.
#include <algorithm>
#include <cmath>

#include "core/surface/grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/surface/sums_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/sph/kernels_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::surface::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace lanes = migiwa::HWY_NAMESPACE;

using Row = hn::CappedTag<float, Block::kSide>;

/// The first and the last of the nodes 0 to 7, `step` apart, that are within `reach` of a place.
struct Range {
  int from, to;
};
HWY_INLINE Range nodesWithin(float at, float reach, float inverseStep) {
  const float from = std::ceil((at - reach) * inverseStep), to = std::floor((at + reach) * inverseStep);
  return {static_cast<int>(std::max(from, 0.0F)),
          static_cast<int>(std::min(to, static_cast<float>(Block::kSide - 1)))};
}

template <class Kernel>
HWY_INLINE void addParticle(const Vec3f& at, float weight, float step, float* HWY_RESTRICT sums) {
  const Row d;
  const float inverseStep = 1 / step;
  const Range zs = nodesWithin(at.z(), 1, inverseStep);
  for (int z = zs.from; z <= zs.to; ++z) {
    const float dz = at.z() - step * static_cast<float>(z);
    const float left = 1 - dz * dz;
    if (left <= 0) continue;
    const Range ys = nodesWithin(at.y(), std::sqrt(left), inverseStep);
    for (int y = ys.from; y <= ys.to; ++y) {
      const float dy = at.y() - step * static_cast<float>(y);
      const float across = dy * dy + dz * dz;
      if (across >= 1) continue;
      const float reach = std::sqrt(1 - across);
      if (at.x() + reach < 0 || at.x() - reach > step * static_cast<float>(Block::kSide - 1)) continue;
      float* const row = sums + Block::index(0, y, z);
      for (std::size_t x = 0; x < Block::kSide; x += hn::Lanes(d)) {
        const auto nodes = hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(x)));
        const auto dx = hn::NegMulAdd(hn::Set(d, step), nodes, hn::Set(d, at.x()));
        const auto r = lanes::distances(d, hn::MulAdd(dx, dx, hn::Set(d, across)));
        const auto shape = lanes::KernelVectors<Kernel>::shape(d, r);
        hn::StoreU(hn::MulAdd(hn::Set(d, weight), shape, hn::LoadU(d, row + x)), d, row + x);
      }
    }
  }
}

void addSums(const SortedParticles& particles, std::span<const CellGrid::Places> rows,
             const BlockFrame& frame, std::span<float, Block::kNodes> sums) {
  const double inverse = 1 / static_cast<double>(particles.supportRadius);
  const auto step = static_cast<float>(frame.step * inverse);
  withKernel(particles.kernel, [&](auto kernel) {
    using Kernel = decltype(kernel);
    for (const CellGrid::Places& row : rows) {
      for (std::uint32_t k = row.from; k < row.to; ++k) {
        const Float4& particle = particles.positions[k];
        const Vec3f at = ((particle.xyz().cast<double>() - frame.first) * inverse).template cast<float>();
        addParticle<Kernel>(at, particle.w * lanes::KernelVectors<Kernel>::kValue, step, sums.data());
      }
    }
  });
}

}  // namespace migiwa::surface::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa::surface {

HWY_EXPORT(addSums);

void addKernelSums(const SortedParticles& particles, std::span<const CellGrid::Places> rows,
                   const BlockFrame& frame, std::span<float, Block::kNodes> sums) {
  HWY_DYNAMIC_DISPATCH(addSums)(particles, rows, frame, sums);
}

}  // namespace migiwa::surface
#endif
