// Where the fluid may be, on a fine lattice near walls: at every point the integral of the fluid side's
// indicator under a tent one spacing wide (trilinear, integral 1). So the sum over the lattice of the values
// times weights is the exact integral, over the fluid side, of the trilinear function through the weights.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/boundary/boundary.h"
#include "core/boundary/spline_fit.h"

namespace migiwa {

/// The place of (x, y, z) in an array of cubes of `side` rows of `stride`.
constexpr std::size_t cubeIndex(int x, int y, int z, int side, int stride) {
  const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(side) + static_cast<std::size_t>(y);
  return row * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
}

class FluidLattice {
 public:
  /// Points of the lattice along a block.
  static constexpr int kPoints = 8;
  /// Points that a window holds beyond each side of its block, and along itself.
  static constexpr int kReach = 11, kSide = kPoints - 1 + 2 * kReach;
  /// Of a row of a window, in memory: whole vectors may be read from any of its places.
  static constexpr int kStride = kSide + 3;
  using Window = std::array<float, std::size_t{kSide} * kSide * kStride>;

  /// About the blocks at `places`, whose first corner is `origin` + place * kPoints * `spacing` (m).
  FluidLattice(const Boundary& boundary, const Vec3f& origin, float spacing,
               const std::vector<BlockPlace>& places, ThreadPool& pool);

  /// Copies the values about a block of `places`, x fastest. False where all of them are the same one, which
  /// is then the only one that is set, in front.
  bool window(const BlockPlace& place, Window& out) const;

 private:
  static constexpr int kAround = 2;  // blocks that a window reaches beyond its own
  static constexpr std::size_t kValues = std::size_t{kPoints} * kPoints * kPoints;
  static constexpr std::int32_t kFluid = -1, kSolid = -2, kUnknown = -3, kWanted = -4;
  using Values = std::array<float, kValues>;

  std::size_t indexOf(const BlockPlace& place) const;
  std::int32_t& at(const BlockPlace& place) { return blocks_[indexOf(place)]; }
  std::int32_t at(const BlockPlace& place) const { return blocks_[indexOf(place)]; }
  void fill(const Boundary& boundary, const Vec3f& first, Values& values) const;

  float spacing_;
  BlockPlace low_{}, size_{};
  std::vector<std::int32_t> blocks_;  ///< kFluid, kSolid, or the place in values_
  std::vector<Values> values_;
};

}  // namespace migiwa
