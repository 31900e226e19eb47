// Meshes and oriented points: what SLIM surfaces are fitted to.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace migiwa {

// Points of a solid's surface with normals that point out of the solid: what SLIM surfaces are fitted to.

struct OrientedPoint {
  Vec3f position;  ///< (m)
  Vec3f normal;    ///< unit, out of the solid
};

struct OrientedPoints {
  std::vector<OrientedPoint> points;
  /// Whether they cover the whole surface of a solid, so that every point of space is inside or outside.
  bool closed = true;
};

// The cells of an endless uniform grid that hold something, found by a hash of their coordinates: the same
// cost however large the grid is.

struct CellCoordinates {
  std::int32_t x, y, z;
};

/// The cell along one axis that a coordinate, in edges of cells, lies in; the last one for all that is
/// farther than a whole number counts, and for what is no number.
inline std::int32_t cellAlong(float place) {
  constexpr float kLast = 1 << 30;
  return static_cast<std::int32_t>(std::fmin(std::fmax(std::floor(place), -kLast), kLast));
}

/// Coordinates in one number; exact for |coordinate| < 2^20.
inline std::uint64_t cellKey(const CellCoordinates& cell) {
  constexpr std::int64_t kHalf = std::int64_t{1} << 20;
  return static_cast<std::uint64_t>(cell.x + kHalf) | static_cast<std::uint64_t>(cell.y + kHalf) << 21 |
         static_cast<std::uint64_t>(cell.z + kHalf) << 42;
}

/// The range of entries that each occupied cell has in an array sorted by cell.
class CellHash {
 public:
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };

  /// `sortedKeys[k]` is the cell of entry k.
  void build(const std::vector<std::uint64_t>& sortedKeys);
  /// Empty for a cell that holds nothing.
  Range find(std::uint64_t key) const {
    if (slots_.empty()) return {};
    for (std::size_t slot = hash(key) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot].key == key) return slots_[slot].range;
      if (slots_[slot].key == kEmpty) return {};
    }
  }
  std::size_t cells() const { return cells_; }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kEmpty;
    Range range;
  };
  static std::size_t hash(std::uint64_t key) {
    key *= 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(key ^ key >> 32);
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0, cells_ = 0;
};

// Points by cells of one edge, so that those near a place are found at the same cost however many there are.

class NearPoints {
 public:
  /// `reach` in m, greater than 0.
  NearPoints(std::vector<Vec3f> points, double reach);

  bool empty() const { return points_.empty(); }
  /// Calls visit(index) for the points nearer than the reach to p, by their places in the vector that was
  /// given, until it returns false.
  template <class Visit>
  void within(const Vec3f& p, const Visit& visit) const {
    const Cell cell = cellOf(p);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const CellHash::Range range = hash_.find(keyOf(cell + Cell(dx, dy, dz)));
          for (std::uint32_t k = range.begin; k < range.end; ++k)
            if ((points_[k] - p).cast<double>().squaredNorm() < reach_ * reach_ && !visit(order_[k])) return;
        }
  }

 private:
  using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
  Cell cellOf(const Vec3f& p) const;
  /// Cells far apart may share a key: distances tell them apart.
  static std::uint64_t keyOf(const Cell& cell) {
    constexpr std::uint64_t kBits = (std::uint64_t{1} << 21U) - 1;
    return (static_cast<std::uint64_t>(cell.x()) & kBits) |
           (static_cast<std::uint64_t>(cell.y()) & kBits) << 21U |
           (static_cast<std::uint64_t>(cell.z()) & kBits) << 42U;
  }

  double reach_;
  std::vector<Vec3f> points_;         ///< cell by cell
  std::vector<std::uint32_t> order_;  ///< where each of them was
  CellHash hash_;
};

// Oriented points in a fixed random order, and every fourth of them, and every sixteenth, ...: a ball of any
// size finds about as many points as a fit needs.

class PointLevels {
 public:
  explicit PointLevels(const std::vector<OrientedPoint>& points);

  /// All of them, in the random order; indices below are places in it.
  std::span<const OrientedPoint> points() const { return points_; }
  /// Length (m) such that there is about one point per square of that edge.
  float spacing() const { return spacing_; }

  /// Indices of the points nearer than `radius` to `centre`, of the coarsest level that can be expected to
  /// have `wanted` of them on a smooth surface.
  void within(const Vec3f& centre, float radius, float wanted, std::vector<std::uint32_t>& out) const;
  /// The same of all points.
  void withinAll(const Vec3f& centre, float radius, std::vector<std::uint32_t>& out) const;

 private:
  struct Level {
    float inverseCell = 1;
    CellHash hash;
    std::vector<std::uint32_t> order;  ///< indices of points, cell by cell
    std::vector<Vec3f> positions;      ///< theirs, side by side in memory as they are looked at
  };
  void collect(const Level& level, const Vec3f& centre, float radius, std::vector<std::uint32_t>& out) const;
  /// Builds a level of the first `count` points; returns the mean number of points in an occupied cell.
  double build(Level& level, std::size_t count, float cell) const;

  std::vector<OrientedPoint> points_;
  std::vector<Level> levels_;
  float spacing_ = 1;
};

// Random numbers that are the same everywhere (SplitMix64): for sampling and shuffling.

class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27) * 0x94D049BB133111EBU;
    return z ^ z >> 31;
  }
  /// Even in [0, 1).
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// In [0, count).
  std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(unit() * static_cast<double>(count));
  }

 private:
  std::uint64_t state_;
};

// Which of numbered things hang together.

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) {
    for (std::uint32_t k = 0; k < count; ++k) parents_[k] = k;
  }
  /// The least of those that hang together with k.
  std::uint32_t least(std::uint32_t k) {
    while (parents_[k] != k) k = parents_[k] = parents_[parents_[k]];
    return k;
  }
  /// Whether the two did not hang together before.
  bool join(std::uint32_t one, std::uint32_t other) {
    const std::uint32_t a = least(one), b = least(other);
    parents_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

// Triangles over shared vertices.

struct TriangleMesh {
  std::vector<Vec3f> vertices;  ///< (m)
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  ///< counter-clockwise seen from the fluid's side, or outside

  Bounds bounds() const;
};

// Points spread evenly over a mesh.

/// About `count` points, as many to every triangle as its area asks for, evenly spread within it, with the
/// triangles' normals. Other seeds give other points.
std::vector<OrientedPoint> samplePoints(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

/// As many as a fit of this many nodes (0: not known) needs.
std::size_t sampleCount(const TriangleMesh& mesh, int nodes);

}  // namespace migiwa
