// Oriented points in a fixed random order, and every fourth of them, and every sixteenth, ...: a ball of any
// size finds about as many points as a fit needs.
#pragma once

#include <span>
#include <vector>

#include "core/slim/cell_hash.h"
#include "core/slim/oriented_points.h"

namespace migiwa {

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

}  // namespace migiwa
