// The sums of kernels on a plane: each particle adds to the rows that it reaches, several cells at a time.
#include <algorithm>
#include <cmath>

#include "core/surface/section.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/surface/section_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/sph/kernels_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::surface::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace lanes = migiwa::HWY_NAMESPACE;

using Cells = hn::CappedTag<float, 16>;
static_assert(kSectionExtra >= 16);

template <class Kernel>
HWY_INLINE void addDisc(const NearPlane& particle, float weight, float reach, const SectionRows& rows) {
  const Cells d;
  const float inverse = 1 / reach;
  const float half = std::sqrt(1 - particle.squared) * reach;
  const int first = std::max(rows.from, static_cast<int>(std::ceil(particle.row - half)));
  const int last = std::min(rows.to - 1, static_cast<int>(std::floor(particle.row + half)));
  const auto scale = hn::Set(d, inverse);
  const auto own = hn::Set(d, weight), valued = hn::Set(d, weight * particle.value);
  for (int row = first; row <= last; ++row) {
    const float dy = (static_cast<float>(row) - particle.row) * inverse;
    const float aside = particle.squared + dy * dy;
    if (!(aside < 1)) continue;
    const float width = std::sqrt(1 - aside) * reach;
    const int from = std::max(0, static_cast<int>(std::ceil(particle.column - width)));
    const int to = std::min(rows.columns - 1, static_cast<int>(std::floor(particle.column + width)));
    const std::size_t begin = static_cast<std::size_t>(row - rows.from) * rows.stride;
    const auto fixed = hn::Set(d, aside);
    for (int column = from; column <= to; column += static_cast<int>(hn::Lanes(d))) {
      const auto dx = hn::Mul(
          hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(column) - particle.column)), scale);
      const auto r = lanes::distances(d, hn::Add(hn::Mul(dx, dx), fixed));
      const auto shape = lanes::KernelVectors<Kernel>::shape(d, r);
      float* const weights = rows.weights + begin + static_cast<std::size_t>(column);
      float* const values = rows.values + begin + static_cast<std::size_t>(column);
      hn::StoreU(hn::MulAdd(own, shape, hn::LoadU(d, weights)), d, weights);
      hn::StoreU(hn::MulAdd(valued, shape, hn::LoadU(d, values)), d, values);
    }
  }
}

void addAll(std::span<const NearPlane> particles, float weight, float reach, KernelType type,
            const SectionRows& rows) {
  withKernel(type, [&](auto kernel) {
    using Kernel = decltype(kernel);
    const float scaled = weight * lanes::KernelVectors<Kernel>::kValue;
    for (const NearPlane& particle : particles) addDisc<Kernel>(particle, scaled, reach, rows);
  });
}

}  // namespace migiwa::surface::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa::surface {

HWY_EXPORT(addAll);

void addToRows(std::span<const NearPlane> particles, float weight, float reach, KernelType kernel,
               const SectionRows& rows) {
  HWY_DYNAMIC_DISPATCH(addAll)(particles, weight, reach, kernel, rows);
}

}  // namespace migiwa::surface
#endif
