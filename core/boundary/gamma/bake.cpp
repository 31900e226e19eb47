#include "core/boundary/gamma/bake.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/error.h"
#include "core/boundary/gamma/volume_rays.h"

namespace migiwa {

namespace {

constexpr int kCells = GammaGrid::kCells;
constexpr double kMostBlocks = 256.0 * 1024 * 1024;

[[noreturn]] void refuse(const std::string& place, double bytes) {
  constexpr double kGiB = 1024.0 * 1024 * 1024;
  char text[200];
  std::snprintf(text, sizeof text,
                "expected walls that a grid of at most %.0f GiB can hold, found some that need %.1f GiB; "
                "\"directions\" needs none, and a larger spacing a smaller one",
                kMostGridBytes / kGiB, bytes / kGiB);
  throw InputError(place, text);
}

/// A coefficient, or gamma, for the density kernel and for the kernel of the pair gradients.
using Values = std::array<float, 2>;

/// Nodes in blocks of kCells^3, for all blocks of a grid and one more around it; only near blocks that have
/// coefficients.
class NodeBlocks {
 public:
  static constexpr std::size_t kNodes = std::size_t{kCells} * kCells * kCells;
  using Block = std::array<Values, kNodes>;
  using Place = std::array<std::int32_t, 3>;

  explicit NodeBlocks(const GammaGrid& grid) {
    std::size_t all = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      size_[axis] = grid.size[axis] + 2;
      all *= static_cast<std::size_t>(size_[axis]);
    }
    index_.assign(all, -1);
    std::size_t block = 0;
    for (std::int32_t z = 0; z < grid.size[2]; ++z)
      for (std::int32_t y = 0; y < grid.size[1]; ++y)
        for (std::int32_t x = 0; x < grid.size[0]; ++x)
          if (grid.blocks[block++] >= 0) addAround({x, y, z});
  }

  const std::vector<Place>& places() const { return places_; }
  /// The block at a place, which may lie one outside the grid; -1: not there.
  std::int32_t at(std::int32_t x, std::int32_t y, std::int32_t z) const {
    if (x < -1 || y < -1 || z < -1 || x >= size_[0] - 1 || y >= size_[1] - 1 || z >= size_[2] - 1) return -1;
    return index_[indexOf({x, y, z})];
  }

 private:
  std::size_t indexOf(const Place& place) const {
    return (static_cast<std::size_t>(place[2] + 1) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(place[1] + 1)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(place[0] + 1);
  }
  void addAround(const Place& center) {
    for (std::int32_t z = -1; z <= 1; ++z) {
      for (std::int32_t y = -1; y <= 1; ++y) {
        for (std::int32_t x = -1; x <= 1; ++x) {
          const Place place{center[0] + x, center[1] + y, center[2] + z};
          std::int32_t& index = index_[indexOf(place)];
          if (index >= 0) continue;
          index = static_cast<std::int32_t>(places_.size());
          places_.push_back(place);
        }
      }
    }
  }

  std::array<std::int32_t, 3> size_{};
  std::vector<std::int32_t> index_;
  std::vector<Place> places_;
};

using Nodes = std::vector<NodeBlocks::Block>;

/// Calls take(number, value) for the nodes [-Before, kCells + Behind) about a block along each axis, x
/// fastest; null for those that are not there.
template <int Before, int Behind, class Take>
void gather(const NodeBlocks& layout, const Nodes& nodes, const NodeBlocks::Place& place, const Take& take) {
  std::size_t at = 0;
  for (int z = -Before; z < kCells + Behind; ++z) {
    for (int y = -Before; y < kCells + Behind; ++y) {
      for (int x = -Before; x < kCells + Behind; ++x, ++at) {
        const auto side = [](int k) { return k < 0 ? -1 : k >= kCells ? 1 : 0; };
        const auto within = [](int k) { return static_cast<std::size_t>((k + kCells) % kCells); };
        const std::int32_t block = layout.at(place[0] + side(x), place[1] + side(y), place[2] + side(z));
        const std::size_t node = (within(z) * kCells + within(y)) * kCells + within(x);
        take(at, block < 0 ? nullptr : &nodes[static_cast<std::size_t>(block)][node]);
      }
    }
  }
}

/// One step from values towards the coefficients of the spline through them: adds what the spline lacks.
void sharpen(const NodeBlocks& layout, const Nodes& values, const Nodes& coefficients, std::size_t block,
             NodeBlocks::Block& out) {
  constexpr std::size_t kSide = kCells + 2;
  std::array<Values, kSide * kSide * kSide> around{};
  std::array<bool, kSide * kSide * kSide> known{};
  gather<1, 1>(layout, coefficients, layout.places()[block], [&](std::size_t at, const Values* value) {
    known[at] = value != nullptr;
    if (value != nullptr) around[at] = *value;
  });
  constexpr std::array<float, 3> kSpline{1.0F / 6, 2.0F / 3, 1.0F / 6};
  std::size_t node = 0;
  for (std::size_t z = 0; z < kCells; ++z) {
    for (std::size_t y = 0; y < kCells; ++y) {
      for (std::size_t x = 0; x < kCells; ++x, ++node) {
        const Values own = coefficients[block][node];
        Values spline{};
        for (std::size_t k = 0; k < 27; ++k) {
          const std::size_t i = k % 3, j = k / 3 % 3, l = k / 9;
          const std::size_t at = ((z + l) * kSide + y + j) * kSide + x + i;
          const float weight = kSpline[i] * kSpline[j] * kSpline[l];
          for (std::size_t v = 0; v < 2; ++v) spline[v] += weight * (known[at] ? around[at][v] : own[v]);
        }
        for (std::size_t v = 0; v < 2; ++v) out[node][v] = own[v] + values[block][node][v] - spline[v];
      }
    }
  }
}

}  // namespace

double blocksIn(const BakeSettings& settings) {
  const double edge = kCells * static_cast<double>(settings.cell);
  return ((settings.region.size() / edge).array().floor() + 1).prod();
}

GammaGrid layOut(const Boundary& boundary, const BakeSettings& settings) {
  GammaGrid grid;
  grid.cell = settings.cell;
  grid.origin = settings.region.min.cast<float>();
  const double edge = kCells * static_cast<double>(settings.cell);
  if (const double blocks = blocksIn(settings); !(blocks < kMostBlocks))
    refuse(settings.place, sizeof(std::int32_t) * blocks);
  for (int axis = 0; axis < 3; ++axis)
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(settings.region.size()[axis] / edge) + 1;
  const float h = settings.supportRadius, half = 0.5F * static_cast<float>(edge);
  const float around = std::sqrt(3.0F) * half;
  std::int32_t used = 0;
  for (std::int32_t z = 0; z < grid.size[2]; ++z) {
    for (std::int32_t y = 0; y < grid.size[1]; ++y) {
      for (std::int32_t x = 0; x < grid.size[0]; ++x) {
        const Vec3f index(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        const Vec3f center = grid.origin + static_cast<float>(edge) * index + Vec3f::Constant(half);
        const float distance = boundary.distance(center);
        // What a thin wall hides jumps across it: no spline.
        const bool thin =
            std::any_of(boundary.surfaces().begin(), boundary.surfaces().end(), [&](const auto& s) {
              Vec3f ignored;
              return s->thickness() < h && s->distance(center, ignored) < h + around;
            });
        if (distance >= h + around) {
          grid.blocks.push_back(GammaGrid::kFar);
        } else if (thin || distance <= -(settings.cell + around)) {
          grid.blocks.push_back(GammaGrid::kElsewhere);
        } else {
          grid.blocks.push_back(used++);
        }
      }
    }
  }
  const double bytes = static_cast<double>(used) * GammaGrid::kBlockFloats * sizeof(float);
  if (bytes > kMostGridBytes) refuse(settings.place, bytes);
  return grid;
}

void bake(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool, GammaGrid& grid) {
  const NodeBlocks layout(grid);
  const std::size_t count = layout.places().size();
  const VolumeRays rays(boundary, settings.kernel, settings.supportRadius, settings.directions);
  Nodes values(count);
  pool.run(count, [&](std::size_t block) {
    VolumeRays::Scratch scratch;
    for (std::size_t node = 0; node < NodeBlocks::kNodes; ++node) {
      const auto along = [&](std::size_t axis, std::size_t within) {
        return static_cast<float>(layout.places()[block][axis] * kCells + static_cast<std::int32_t>(within));
      };
      const Vec3f index(along(0, node % kCells), along(1, node / kCells % kCells),
                        along(2, node / kCells / kCells));
      values[block][node] = rays.at(grid.origin + settings.cell * index, scratch);
    }
  });

  // Each step leaves, of a wave of two support radii in the values, about a twentieth of the error.
  constexpr int kSteps = 4;
  Nodes coefficients = values, next(count);
  for (int step = 0; step < kSteps; ++step) {
    pool.run(count, [&](std::size_t block) { sharpen(layout, values, coefficients, block, next[block]); });
    coefficients.swap(next);
  }

  std::size_t used = 0;
  for (const std::int32_t block : grid.blocks) used += block >= 0 ? 1 : 0;
  grid.coefficients.resize(used * GammaGrid::kBlockFloats);
  std::size_t block = 0;
  for (std::int32_t z = 0; z < grid.size[2]; ++z) {
    for (std::int32_t y = 0; y < grid.size[1]; ++y) {
      for (std::int32_t x = 0; x < grid.size[0]; ++x, ++block) {
        if (grid.blocks[block] < 0) continue;
        float* to =
            &grid.coefficients[static_cast<std::size_t>(grid.blocks[block]) * GammaGrid::kBlockFloats];
        gather<1, 2>(layout, coefficients, {x, y, z}, [&](std::size_t at, const Values* value) {
          const Values known = value != nullptr ? *value : Values{};  // never missing about a block
          to[2 * at] = known[0];
          to[2 * at + 1] = known[1];
        });
      }
    }
  }
}

}  // namespace migiwa
