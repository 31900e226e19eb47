#include <algorithm>
#include <cmath>

#include "core/gamma/baked.h"

namespace migiwa {

namespace {

/// Places along a cell's edge at which it is asked whether they are fluid.
constexpr int kSamples = 4;
constexpr std::size_t kCellSamples = std::size_t{kSamples} * kSamples * kSamples;

/// The tents of a cell's eight corners at its samples.
struct Tents {
  float weight[kCellSamples][8];

  constexpr Tents() : weight() {
    for (std::size_t s = 0; s < kCellSamples; ++s) {
      const float t[3] = {placeOf(s % kSamples), placeOf(s / kSamples % kSamples),
                          placeOf(s / kSamples / kSamples)};
      for (std::size_t corner = 0; corner < 8; ++corner) {
        weight[s][corner] = 1;
        for (std::size_t axis = 0; axis < 3; ++axis)
          weight[s][corner] *= (corner >> axis & 1U) != 0 ? t[axis] : 1 - t[axis];
      }
    }
  }
  static constexpr float placeOf(std::size_t sample) {
    return (static_cast<float>(sample) + 0.5F) / kSamples;
  }
};
constexpr Tents kTents;

/// The part of a sample's box that is fluid, for the distance of its middle over its width.
float fluidPart(float distance) {
  return std::clamp(0.5F + distance, 0.0F, 1.0F);
}

/// Whether eight distances are those to one plane, nearly: not those to a crease.
bool flat(const float (&d)[8], float tolerance) {
  float mean = 0, slope[3] = {};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    mean += 0.125F * d[corner];
    for (std::size_t axis = 0; axis < 3; ++axis)
      slope[axis] += (corner >> axis & 1U) != 0 ? 0.125F * d[corner] : -0.125F * d[corner];
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    float linear = mean;
    for (std::size_t axis = 0; axis < 3; ++axis)
      linear += (corner >> axis & 1U) != 0 ? slope[axis] : -slope[axis];
    if (std::abs(d[corner] - linear) > tolerance) return false;
  }
  return true;
}

/// Distances at the points of a block's cells, those before the block included. Where a point is farther from
/// the walls than its neighbours along x, they are known to be on the same side.
class BlockDistances {
 public:
  static constexpr int kSide = FluidLattice::kPoints + 2;

  BlockDistances(const Boundary& boundary, const Vec3f& first, float spacing) {
    const float enough = 2 * spacing;  // more than a cell's diagonal: no wall passes through its cells
    float* to = distances_;
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide;) {
          const Vec3f index(static_cast<float>(x - 1), static_cast<float>(y - 1), static_cast<float>(z - 1));
          const float d = boundary.distance(first + spacing * index);
          float known = std::abs(d);
          do {
            *to++ = known == std::abs(d) ? d : std::copysign(known, d);
            known -= spacing;
            ++x;
          } while (x < kSide && known >= enough);
        }
      }
    }
  }

  void corners(int x, int y, int z, float (&d)[8]) const {
    const float* from = distances_ + cubeIndex(x, y, z, kSide, kSide);
    for (std::size_t corner = 0; corner < 8; ++corner)
      d[corner] = from[(corner >> 2U) * kSide * kSide + (corner >> 1U & 1U) * kSide + (corner & 1U)];
  }

 private:
  float distances_[std::size_t{kSide} * kSide * kSide];
};

}  // namespace

FluidLattice::FluidLattice(const Boundary& boundary, const Vec3f& origin, float spacing,
                           const std::vector<BlockPlace>& places, ThreadPool& pool)
    : spacing_(spacing) {
  if (places.empty()) return;
  BlockPlace high = places.front();
  low_ = places.front();
  for (const BlockPlace& place : places) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min(low_[axis], place[axis] - kAround);
      high[axis] = std::max(high[axis], place[axis] + kAround);
    }
  }
  std::size_t all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = high[axis] - low_[axis] + 1;
    all *= static_cast<std::size_t>(size_[axis]);
  }
  blocks_.assign(all, kUnknown);
  std::vector<BlockPlace> wanted;
  for (const BlockPlace& place : places) {
    for (int z = -kAround; z <= kAround; ++z) {
      for (int y = -kAround; y <= kAround; ++y) {
        for (int x = -kAround; x <= kAround; ++x) {
          const BlockPlace near{place[0] + x, place[1] + y, place[2] + z};
          if (at(near) != kUnknown) continue;
          at(near) = kWanted;
          wanted.push_back(near);
        }
      }
    }
  }

  // A block's values look one spacing back, so its middle is half a spacing before that of its points.
  const auto firstOf = [&](const BlockPlace& place) {
    return Vec3f(origin + kPoints * spacing *
                              Vec3f(static_cast<float>(place[0]), static_cast<float>(place[1]),
                                    static_cast<float>(place[2])));
  };
  const float half = 0.5F * static_cast<float>(kPoints + 1) * spacing;
  constexpr float kDiagonal = 1.7320508F;
  std::vector<std::int32_t> sides(wanted.size());
  pool.run(wanted.size(), [&](std::size_t k) {
    const Vec3f middle = firstOf(wanted[k]) + Vec3f::Constant(half - spacing);
    const float distance = boundary.distance(middle);
    const bool near = std::abs(distance) < kDiagonal * half + spacing;
    sides[k] = near ? kUnknown : distance > 0 ? kFluid : kSolid;
  });
  std::vector<BlockPlace> cut;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    at(wanted[k]) = sides[k];
    if (sides[k] != kUnknown) continue;
    at(wanted[k]) = static_cast<std::int32_t>(cut.size());
    cut.push_back(wanted[k]);
  }
  values_.resize(cut.size());
  pool.run(cut.size(), [&](std::size_t k) { fill(boundary, firstOf(cut[k]), values_[k]); });
}

std::size_t FluidLattice::indexOf(const BlockPlace& place) const {
  std::size_t index = 0;
  for (std::size_t axis = 3; axis-- > 0;)
    index =
        index * static_cast<std::size_t>(size_[axis]) + static_cast<std::size_t>(place[axis] - low_[axis]);
  return index;
}

void FluidLattice::fill(const Boundary& boundary, const Vec3f& first, Values& values) const {
  constexpr int kCells = kPoints + 1;
  constexpr float kFlat = 0.03F;  // spacings
  const BlockDistances distances(boundary, first, spacing_);
  values.fill(0);
  for (int z = 0; z < kCells; ++z) {
    for (int y = 0; y < kCells; ++y) {
      for (int x = 0; x < kCells; ++x) {
        float d[8], parts[8] = {};
        distances.corners(x, y, z, d);
        const auto [least, most] = std::minmax_element(d, d + 8);
        if (*least >= 2 * spacing_ || *most <= -2 * spacing_) {
          std::fill(parts, parts + 8, *least > 0 ? 0.125F : 0.0F);
        } else {
          const bool known = flat(d, kFlat * spacing_);
          const float scale = kSamples / spacing_;
          for (std::size_t s = 0; s < kCellSamples; ++s) {
            const float(&tents)[8] = kTents.weight[s];
            float distance = 0;
            if (known) {
              for (std::size_t corner = 0; corner < 8; ++corner) distance += tents[corner] * d[corner];
            } else {
              const Vec3f at(static_cast<float>(x - 1) + Tents::placeOf(s % kSamples),
                             static_cast<float>(y - 1) + Tents::placeOf(s / kSamples % kSamples),
                             static_cast<float>(z - 1) + Tents::placeOf(s / kSamples / kSamples));
              distance = boundary.distance(first + spacing_ * at);
            }
            const float part = fluidPart(distance * scale) / static_cast<float>(kCellSamples);
            for (std::size_t corner = 0; corner < 8; ++corner) parts[corner] += part * tents[corner];
          }
        }
        for (int corner = 0; corner < 8; ++corner) {
          const int px = x - 1 + (corner & 1), py = y - 1 + (corner >> 1 & 1), pz = z - 1 + (corner >> 2);
          if (px < 0 || py < 0 || pz < 0 || px >= kPoints || py >= kPoints || pz >= kPoints) continue;
          values[cubeIndex(px, py, pz, kPoints, kPoints)] += parts[corner];
        }
      }
    }
  }
}

bool FluidLattice::window(const BlockPlace& place, Window& out) const {
  const std::int32_t own = at(place);
  bool same = own < 0;
  for (int z = -kAround; z <= kAround && same; ++z)
    for (int y = -kAround; y <= kAround && same; ++y)
      for (int x = -kAround; x <= kAround && same; ++x)
        same = at({place[0] + x, place[1] + y, place[2] + z}) == own;
  if (same) {
    out[0] = own == kFluid ? 1 : 0;
    return false;
  }
  // Along an axis, point k of the window is point (k - kReach) mod kPoints of one of five blocks.
  const auto blockOf = [](int k) { return (k - kReach + kAround * kPoints) / kPoints - kAround; };
  const auto pointOf = [](int k) { return (k - kReach + kAround * kPoints) % kPoints; };
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      float* row = &out[cubeIndex(0, y, z, kSide, kStride)];
      for (int x = 0; x < kSide;) {
        const std::int32_t block = at({place[0] + blockOf(x), place[1] + blockOf(y), place[2] + blockOf(z)});
        const int point = pointOf(x), count = std::min(kPoints - point, kSide - x);
        if (block < 0) {
          std::fill(row + x, row + x + count, block == kFluid ? 1.0F : 0.0F);
        } else {
          const Values& values = values_[static_cast<std::size_t>(block)];
          const float* from = &values[cubeIndex(point, pointOf(y), pointOf(z), kPoints, kPoints)];
          std::copy(from, from + count, row + x);
        }
        x += count;
      }
      std::fill(row + kSide, row + kStride, 0.0F);
    }
  }
  return true;
}

}  // namespace migiwa
