#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "core/base/files.h"
#include "core/base/math.h"
#include "core/base/messages.h"
#include "core/gamma/baked.h"
#include "core/sph/kernels.h"
#include "core/walls/gridded.h"

namespace migiwa {

namespace {

constexpr int kCells = GammaGrid::kCells;
/// What filling a grid takes in all, over the grid itself.
constexpr double kFillingOverGrid = 4;
constexpr double kMostGridBlocks = 256.0 * 1024 * 1024;

[[noreturn]] void refuse(const std::string& place, double bytes) {
  constexpr double kGiB = 1024.0 * 1024 * 1024;
  char text[200];
  std::snprintf(text, sizeof text,
                "expected walls that a grid of at most %.0f GiB can hold, found some that need %.1f GiB; "
                "\"directions\" needs none, and a larger spacing a smaller one",
                kMostGridBytes / kGiB, bytes / kGiB);
  throw InputError(place, text);
}

/// gamma for the two kernels at the nodes of blocks: what is fluid about a node, weighed by their stencils.
class NodeGammas {
 public:
  NodeGammas(const FluidLattice& fluid, KernelType kernel)
      : fluid_(fluid),
        density_(kernelStencil(kernel)),
        pair_(kernel == KernelType::poly6 ? kernelStencil(KernelType::spiky) : density_) {}

  void fill(const BlockPlace& place, BlockValues<2>& values) const {
    FluidLattice::Window window;
    if (!fluid_.window(place, window)) {
      values.fill({window[0], window[0]});
      return;
    }
    for (std::size_t node = 0; node < values.size(); ++node) {
      constexpr std::size_t kPerCell = FluidLattice::kPoints / kCells;
      const std::size_t x = kPerCell * (node % kCells), y = kPerCell * (node / kCells % kCells),
                        z = kPerCell * (node / kCells / kCells);
      values[node] = around(&window[(z * FluidLattice::kSide + y) * FluidLattice::kStride + x]);
    }
  }

 private:
  static constexpr std::size_t kRow = KernelStencil::kStride;

  /// `fluid`: the first of the values that a stencil covers.
  std::array<float, 2> around(const float* fluid) const {
    std::array<float, kRow> density{}, pair{};
    const float* one = density_.weights.data();
    const float* other = pair_.weights.data();
    for (int z = 0; z < KernelStencil::kSide; ++z) {
      for (int y = 0; y < KernelStencil::kSide; ++y, one += kRow, other += kRow) {
        const float* row =
            fluid + static_cast<std::size_t>(z * FluidLattice::kSide + y) * FluidLattice::kStride;
        for (std::size_t x = 0; x < kRow; ++x) {
          density[x] += one[x] * row[x];
          pair[x] += other[x] * row[x];
        }
      }
    }
    return {std::accumulate(density.begin(), density.end(), 0.0F),
            std::accumulate(pair.begin(), pair.end(), 0.0F)};
  }

  const FluidLattice& fluid_;
  KernelStencil density_, pair_;
};

}  // namespace

double blocksIn(const BakeSettings& settings) {
  const double edge = GammaGrid::kCells * static_cast<double>(settings.cell);
  return ((settings.region.size() / edge).array().floor() + 1).prod();
}

GammaGrid layOut(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool) {
  GammaGrid grid;
  grid.cell = settings.cell;
  grid.origin = settings.region.min.cast<float>();
  if (const double blocks = blocksIn(settings); !(blocks < kMostGridBlocks))
    refuse(settings.place, sizeof(std::int32_t) * blocks);
  // The layout's own index of blocks, and those of the splines and the fluid's lattice.
  requireMemory(3 * sizeof(std::int32_t) * blocksIn(settings), "a grid of gamma", settings.place);
  for (int axis = 0; axis < 3; ++axis)
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(settings.region.size()[axis] / static_cast<double>(grid.blockEdge())) + 1;
  const float h = settings.supportRadius, half = 0.5F * grid.blockEdge();
  const float around = std::sqrt(3.0F) * half;
  std::vector<const Surface*> curves;
  for (const auto& surface : boundary.surfaces())
    if (!surface->planar()) curves.push_back(surface.get());
  constexpr std::int32_t kUsed = 0;
  const auto kindOf = [&](const Vec3f& center) {
    const float distance = boundary.distance(center);
    if (distance >= h + around) return GammaGrid::kFar;
    const bool curved = std::any_of(curves.begin(), curves.end(), [&](const Surface* surface) {
      Vec3f ignored;
      return surface->distance(center, ignored) < h + around;
    });
    if (settings.curvedOnly && !curved) return GammaGrid::kElsewhere;
    // What a thin wall hides jumps across it: no spline.
    const bool hides =
        std::any_of(boundary.surfaces().begin(), boundary.surfaces().end(),
                    [&](const auto& surface) { return surface->thinWithin(center, h + around, h); });
    return hides || distance <= -(settings.cell + around) ? GammaGrid::kElsewhere : kUsed;
  };
  const auto width = static_cast<std::size_t>(grid.size[0]), height = static_cast<std::size_t>(grid.size[1]);
  const std::size_t rows = height * static_cast<std::size_t>(grid.size[2]);
  grid.blocks.resize(rows * width);
  pool.run(rows, [&](std::size_t row) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t y = row % height, z = row / height;
      const Vec3f index(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      grid.blocks[row * width + x] = kindOf(grid.origin + grid.blockEdge() * index + Vec3f::Constant(half));
    }
  });
  std::int32_t used = 0;
  for (std::int32_t& block : grid.blocks)
    if (block == kUsed) block = used++;
  const double bytes = static_cast<double>(used) * GammaGrid::kBlockFloats * sizeof(float);
  if (bytes > kMostGridBytes) refuse(settings.place, bytes);
  requireMemory(kFillingOverGrid * bytes, "a grid of gamma", settings.place);
  return grid;
}

void bake(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool, GammaGrid& grid) {
  const BlockLayout layout(grid.size, grid.blocks);
  const FluidLattice fluid(boundary, grid.origin, settings.supportRadius / KernelStencil::kPerSupport,
                           layout.places(), pool);
  const NodeGammas gammas(fluid, settings.kernel);
  fitSplines<2>(grid, layout, pool,
                [&](const BlockPlace& place, BlockValues<2>& values) { gammas.fill(place, values); });
}

namespace {

/// A cube of numbers about a middle, zero outside.
class Cube {
 public:
  explicit Cube(int reach)
      : reach_(reach), side_(2 * reach + 1), values_(cubeIndex(0, 0, side_, side_, side_), 0.0) {}

  int reach() const { return reach_; }
  double& at(int x, int y, int z) { return values_[indexOf(x, y, z)]; }
  double get(int x, int y, int z) const {
    if (std::abs(x) > reach_ || std::abs(y) > reach_ || std::abs(z) > reach_) return 0;
    return values_[indexOf(x, y, z)];
  }
  template <class Body>
  void forEach(const Body& body) {
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y)
        for (int x = -reach_; x <= reach_; ++x) body(x, y, z, at(x, y, z));
  }

 private:
  std::size_t indexOf(int x, int y, int z) const {
    return cubeIndex(x + reach_, y + reach_, z + reach_, side_, side_);
  }

  int reach_, side_;
  std::vector<double> values_;
};

/// The integral of the kernel under the tent about a point of the lattice.
template <class Kernel>
double underTent(int x, int y, int z) {
  constexpr int kSamples = 6;  // along half of the tent
  double sum = 0;
  for (int k = -kSamples; k < kSamples; ++k) {
    for (int j = -kSamples; j < kSamples; ++j) {
      for (int i = -kSamples; i < kSamples; ++i) {
        const double u = (i + 0.5) / kSamples, v = (j + 0.5) / kSamples, w = (k + 0.5) / kSamples;
        const double q = portable::hypot(x + u, y + v, z + w) / KernelStencil::kPerSupport;
        sum += static_cast<double>(Kernel::value(static_cast<float>(q))) * (1 - std::abs(u)) *
               (1 - std::abs(v)) * (1 - std::abs(w));
      }
    }
  }
  return sum;
}

}  // namespace

KernelStencil kernelStencil(KernelType kernelType) {
  constexpr int kReach = KernelStencil::kReach;
  Cube under(kReach);
  withKernel(kernelType, [&](auto kernel) {
    // One of eight octants, the others by symmetry.
    for (int z = 0; z <= kReach; ++z) {
      for (int y = 0; y <= kReach; ++y) {
        for (int x = 0; x <= kReach; ++x) {
          const double value = underTent<decltype(kernel)>(x, y, z);
          for (int octant = 0; octant < 8; ++octant)
            under.at((octant & 1) != 0 ? -x : x, (octant & 2) != 0 ? -y : y, (octant & 4) != 0 ? -z : z) =
                value;
        }
      }
    }
  });

  // The tents' inner products, 1/6, 2/3 and 1/6 along each axis, times the weights are the integrals under
  // the tents: solved by Richardson's iteration, for the kernel is smooth on the lattice.
  constexpr int kSteps = 12;
  Cube weights = under;
  for (int step = 0; step < kSteps; ++step) {
    const Cube before = weights;
    weights.forEach([&](int x, int y, int z, double& weight) {
      double product = 0;
      for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i)
            product += (i == 0 ? 4 : 1) * (j == 0 ? 4 : 1) * (k == 0 ? 4 : 1) / 216.0 *
                       before.get(x + i, y + j, z + k);
      weight += under.get(x, y, z) - product;
    });
  }
  double sum = 0;
  weights.forEach([&](int, int, int, double& weight) { sum += weight; });
  KernelStencil stencil;
  stencil.weights.fill(0);
  weights.forEach([&](int x, int y, int z, double& weight) {
    stencil.weights[cubeIndex(x + kReach, y + kReach, z + kReach, KernelStencil::kSide,
                              KernelStencil::kStride)] = static_cast<float>(weight / sum);
  });
  return stencil;
}

}  // namespace migiwa
