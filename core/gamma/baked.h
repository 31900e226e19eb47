// Gamma on a sparse grid about the walls, which is made once and kept on disk.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/sph/kernels.h"
#include "core/walls/boundary.h"
#include "core/walls/gridded.h"

namespace migiwa {

// gamma on a sparse grid about the walls. The gradients are those of the splines, so they belong to the gamma
// that is returned.

/// Channels: gamma for the density kernel, and for the kernel of the pair gradients.
using GammaGrid = SplineGrid<2>;

/// Interpolates at places in blocks with coefficients: gamma and gradients, not the distance. Samples of
/// other places are left alone.
void interpolate(const GammaGrid& grid, float supportRadius, std::span<const GammaGrid::Place> places,
                 std::span<GammaSample> out);

// Fills a GammaGrid: gamma at its nodes, on both sides of the walls, then the coefficients of the splines
// through them. Eq. 6 is a convolution of the kernel with the fluid side's indicator, so all that is asked of
// the walls is their distance, on a lattice of a tenth of the support radius (fluid_lattice.h): the cost does
// not depend on what the walls are made of. Behind a solid that ends within the kernel fluid counts again.

struct BakeSettings {
  KernelType kernel;
  float supportRadius;  ///< (m)
  float cell;           ///< (m)
  Bounds region;        ///< what the grid covers (m)
  bool curvedOnly;      ///< leaves the places out that only planar walls reach
  std::string place;    ///< of the gamma method in the scene file, for errors
};

/// Memory that a grid may take (bytes).
inline constexpr double kMostGridBytes = 1024.0 * 1024 * 1024;

/// Blocks in the region, with coefficients or without.
double blocksIn(const BakeSettings& settings);
/// The grid without coefficients: which blocks get some. Throws InputError where they would take too much
/// memory.
GammaGrid layOut(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool);
void bake(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool, GammaGrid& grid);

// Baked grids on disk, so that the second start of a scene finds its grid. A file is taken only if it is
// whole and its key is, word for word, the one that is asked for; anything else counts as no file.

/// Every field of every surface as text, files by their content: what tells one set of walls from another.
std::string describeWalls(const Boundary& boundary);

/// The file for a key, in a folder (cacheFolder()).
std::filesystem::path gridFile(const std::filesystem::path& folder, const std::string& key);

std::optional<GammaGrid> readGrid(const std::filesystem::path& file, const std::string& key);
/// Creates the folder too. Returns whether the file is now there, whole.
bool writeGrid(const std::filesystem::path& file, const std::string& key, const GammaGrid& grid);

// Where the fluid may be, on a fine lattice near walls: at every point the integral of the fluid side's
// indicator under a tent one spacing wide (trilinear, integral 1). So the sum over the lattice of the values
// times weights is the exact integral, over the fluid side, of the trilinear function through the weights.

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

// A kernel as weights on a lattice, for integrals over whatever part of it is fluid (fluid_lattice.h): the
// trilinear function through the weights is the best approximation of W in the mean square, so its integrals
// against everything trilinear are exact.

struct KernelStencil {
  /// Points of the lattice along a support radius.
  static constexpr int kPerSupport = 10;
  static constexpr int kReach = FluidLattice::kReach, kSide = 2 * kReach + 1, kStride = kSide + 1;

  /// Sum 1; x fastest, rows of kStride with a zero at the end.
  std::array<float, std::size_t{kSide} * kSide * kStride> weights;
};

KernelStencil kernelStencil(KernelType kernelType);

}  // namespace migiwa
