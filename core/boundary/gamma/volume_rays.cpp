#include "core/boundary/gamma/volume_rays.h"

#include <algorithm>
#include <cmath>

#include "core/boundary/gamma/ray_sums.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

float planeGammaOf(KernelType kernel, float e) {
  return withKernel(kernel, [e](auto shape) { return decltype(shape)::planeGamma(e); });
}

}  // namespace

VolumeRays::VolumeRays(const Boundary& boundary, KernelType kernel, float supportRadius, int directions)
    : boundary_(boundary),
      kernel_(kernel),
      pairKernel_(kernel == KernelType::poly6 ? KernelType::spiky : kernel),
      support_(supportRadius),
      directions_(groupedDirections(directions)) {}

void VolumeRays::addFluidOf(std::size_t ray, std::size_t surfaces, Scratch& scratch) const {
  if (surfaces == 1) {
    bool solid = scratch.inSolid[0] != 0;
    for (const float t : scratch.crossings[0][ray]) {
      if (t >= support_) break;
      (solid ? scratch.minus : scratch.plus).push_back(t);
      solid = !solid;
    }
    if (!solid) scratch.plus.push_back(support_);
    return;
  }
  auto& changes = scratch.changes;
  changes.clear();
  int solids = 0;
  for (std::size_t s = 0; s < surfaces; ++s) {
    solids += scratch.inSolid[s] != 0 ? 1 : 0;
    for (const float t : scratch.crossings[s][ray])
      if (t < support_) changes.emplace_back(t, s);
  }
  std::sort(changes.begin(), changes.end());
  // Fluid is where no solid is: it ends at plus and began at minus, or at the point itself.
  scratch.inside = scratch.inSolid;
  for (const auto& [t, surface] : changes) {
    char& inside = scratch.inside[surface];
    inside = inside != 0 ? 0 : 1;
    if (inside != 0) {
      if (solids++ == 0) scratch.plus.push_back(t);
    } else if (--solids == 0) {
      scratch.minus.push_back(t);
    }
  }
  if (solids == 0) scratch.plus.push_back(support_);
}

std::array<float, 2> VolumeRays::at(const Vec3f& p, Scratch& scratch) const {
  Vec3f normal;
  const float distance = boundary_.distance(p, normal);
  if (distance >= support_) return {1, 1};
  if (distance <= -support_) return {0, 0};
  std::size_t near = 0;
  bool planar = true;
  scratch.near.clear();
  scratch.inSolid.clear();
  scratch.pieces.clear();
  for (const auto& surface : boundary_.surfaces()) {
    Vec3f ignored;
    const float d = surface->distance(p, ignored);
    if (d >= support_) continue;
    planar = planar && surface->planar();
    if (planar) surface->pieces(p, support_, scratch.pieces);
    scratch.near.push_back(surface.get());
    scratch.inSolid.push_back(d < 0 ? 1 : 0);
  }
  const float e = distance / support_;
  if (planar && scratch.pieces.size() == 1) return {planeGammaOf(kernel_, e), planeGammaOf(pairKernel_, e)};
  for (const Surface* surface : scratch.near) {
    if (scratch.crossings.size() <= near) scratch.crossings.emplace_back();
    scratch.crossings[near].resize(directions_.size());
    surface->crossings(p, directions_, support_, scratch.crossings[near]);
    ++near;
  }
  scratch.plus.clear();
  scratch.minus.clear();
  for (std::size_t k = 0; k < directions_.size(); ++k) addFluidOf(k, near, scratch);
  if (planar) {
    // The closed form of the nearest plane takes the place of its own part of the sum.
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      const float towards =
          -(normal.x() * directions_.x[k] + normal.y() * directions_.y[k] + normal.z() * directions_.z[k]);
      const bool meets = distance >= 0 ? towards > 0 : towards < 0;
      const float t = meets ? std::min(distance / towards, support_) : support_;
      if (distance >= 0) {
        scratch.minus.push_back(t);
      } else {
        scratch.minus.push_back(support_);
        scratch.plus.push_back(t);
      }
    }
  }
  while (scratch.plus.size() % 8 != 0) scratch.plus.push_back(0);
  while (scratch.minus.size() % 8 != 0) scratch.minus.push_back(0);
  const float mean = 1 / static_cast<float>(directions_.size());
  std::array<float, 2> gamma{};
  for (std::size_t k = 0; k < 2; ++k) {
    const KernelType kernel = k == 0 ? kernel_ : pairKernel_;
    if (k == 1 && kernel == kernel_) {
      gamma[1] = gamma[0];
      break;
    }
    gamma[k] =
        mean * (massOfRays(kernel, scratch.plus, support_) - massOfRays(kernel, scratch.minus, support_));
    if (planar) gamma[k] += withKernel(kernel, [e](auto shape) { return decltype(shape)::planeGamma(e); });
    gamma[k] = std::clamp(gamma[k], 0.0F, 1.0F);
  }
  return gamma;
}

}  // namespace migiwa
