// What facets take from the kernels of many points, as sums over the edges of polygons: facets.cpp has the
// equations.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/gamma/batches.h"
#include "core/gamma/half_spaces.h"
#include "core/sph/kernels.h"

namespace migiwa {

/// Of the support radius: so far behind a plane a point is still taken to lie in front of it.
inline constexpr float kOnFacet = 1e-3F;
/// Of the support radius: nearer than that to a plane, a corner of another facet lies on it.
inline constexpr float kFacetRounding = 1e-5F;
/// Of the support radius: from a corner or an edge no facet is seen, so that much a point is kept off walls.
inline constexpr float kClearOfFacets = 1e-4F;

// Lengths are over the support radius, and places relative to the point.

template <class Kernel>
class PolygonSums {
 public:
  void clear() {
    edges_.clear();
    owners_.clear();
  }

  /// Adds `sign` times the integrals over a polygon in a plane at `distance` to sample `i`, which is
  /// `sample`; and, if `open`, those over the sides of the cone behind it. False where it is out of reach.
  bool add(std::size_t i, const Polygon& polygon, const Vec3f& normal, float distance, float sign, bool open,
           GammaSample& sample) {
    const float height = std::abs(distance), side = distance < 0 ? -sign : sign;
    const std::size_t before = owners_.size();
    bool within = true;
    for (int k = 0; k < polygon.count; ++k) {
      const Vec3f &a = polygon.corner(k), way = polygon.corner(k + 1) - a;
      const float length = way.norm();
      if (length < 1e-7F) continue;
      const Vec3f along = way / length, inwards = normal.cross(along);
      const float inside = -a.dot(inwards), from = a.dot(along);
      const float half2 = 1 - height * height - inside * inside;
      if (inside < 0) {
        within = false;
        if (half2 <= 0) {
          owners_.resize(before);
          edges_.resize(before);
          return false;
        }
      }
      float start = 0, end = 0;
      if (!endsOf(from, length, half2, start, end)) continue;
      edges_.push_back({height, inside, start, end});
      owners_.push_back({i, side, sign * normal});
      if (!open) continue;
      const float least = std::sqrt(1 - half2);
      if (least < kFacetRounding) continue;
      edges_.push_back({0, least, start, end});
      owners_.push_back({i, 0, sign / least * (distance * inwards - inside * normal)});
    }
    if (within) addPlane(normal, height, side, sign, sample);
    return true;
  }

  /// The same, open and in front of the point, for the face across an axis of an upright block from `low` to
  /// `high`; `side`: 1 for the upper one, -1.
  bool addFace(std::size_t i, const Vec3f& low, const Vec3f& high, int axis, float side, float distance,
               GammaSample& sample) {
    // The edges counter-clockwise as the point sees them.
    const int one = (axis + (side > 0 ? 1 : 2)) % 3, other = (axis + (side > 0 ? 2 : 1)) % 3;
    const Vec3f lengths = high - low;
    struct Edge {
      float inside, from, length;
      int across;     ///< the axis
      float inwards;  ///< along it
    };
    const Edge edges[4] = {{-low[other], low[one], lengths[one], other, 1},
                           {high[one], low[other], lengths[other], one, -1},
                           {high[other], -high[one], lengths[one], other, -1},
                           {-low[one], -high[other], lengths[other], one, 1}};
    float half2[4];
    bool within = true;
    for (int k = 0; k < 4; ++k) {
      half2[k] = 1 - distance * distance - edges[k].inside * edges[k].inside;
      if (edges[k].inside >= 0 || edges[k].length < 1e-7F) continue;
      if (half2[k] <= 0) return false;
      within = false;
    }
    Vec3f normal = Vec3f::Zero();
    normal[axis] = side;
    for (int k = 0; k < 4; ++k) {
      const Edge& edge = edges[k];
      float start = 0, end = 0;
      if (edge.length < 1e-7F || !endsOf(edge.from, edge.length, half2[k], start, end)) continue;
      edges_.push_back({distance, edge.inside, start, end});
      owners_.push_back({i, 1, normal});
      const float least = std::sqrt(1 - half2[k]);
      if (least < kFacetRounding) continue;
      edges_.push_back({0, least, start, end});
      Owner& cone = owners_.emplace_back(Owner{i, 0, Vec3f::Zero()});
      cone.normal[axis] = 1 / least * -(edge.inside * side);
      cone.normal[edge.across] = 1 / least * (distance * edge.inwards);
    }
    if (within) addPlane(normal, distance, 1, 1, sample);
    return true;
  }

  /// The borders of a tank, the inside of all half-spaces: each takes what is behind its own part.
  void addTanks(std::size_t i, const std::vector<HalfSpace>& tanks, GammaSample& sample) {
    for (std::size_t k = 0; k < tanks.size(); ++k) {
      const HalfSpace& tank = tanks[k];
      // A square that holds the support, in the plane.
      const Vec3f one = tank.normal.unitOrthogonal(), other = tank.normal.cross(one),
                  foot = -tank.e * tank.normal;
      constexpr float kBeyond = 1.01F;
      Polygon polygon;
      for (const auto& [a, b] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}})
        polygon.add(foot + kBeyond * (static_cast<float>(a) * one + static_cast<float>(b) * other));
      for (std::size_t l = 0; l < tanks.size(); ++l)
        if (l != k) clip(polygon, {tanks[l].normal, tanks[l].e});
      if (!polygon.empty()) add(i, polygon, tank.normal, tank.e, 1, false, sample);
    }
  }

  /// What the borders of a tank take behind a polygon that is at `distance`, which the polygon takes already.
  void addBehind(std::size_t i, const Polygon& polygon, float distance, bool open,
                 const std::vector<HalfSpace>& tanks, GammaSample& sample) {
    for (std::size_t k = 0; k < tanks.size(); ++k) {
      const Polygon seen = throughTo(polygon, distance, k, tanks);
      if (!seen.empty())
        add(i, seen, tanks[k].normal, tanks[k].e, distance >= 0 ? -1.0F : 1.0F, open, sample);
    }
  }

  /// Integrates along all edges, and adds what that gives to the samples.
  void finish(KernelType kernel, std::span<GammaSample> samples) {
    integrate(kernel, edges_, results_);
    for (std::size_t k = 0; k < owners_.size(); ++k) {
      const Owner& owner = owners_[k];
      GammaSample& sample = samples[owner.sample];
      sample.gamma += owner.flux * results_[k].flux;
      sample.gradient -= results_[k].area * owner.normal;
      sample.pairGradient -= results_[k].pairArea * owner.normal;
    }
  }

 private:
  /// What the integrals along an edge are added to.
  struct Owner {
    std::size_t sample;
    float flux;    ///< sign, 0 for the side of a cone
    Vec3f normal;  ///< with the sign
  };

  /// Where an edge is in the support, half2 the squared half of its line there. False where it is not.
  static bool endsOf(float from, float length, float half2, float& start, float& end) {
    if (half2 <= 0) return false;
    const float half = std::sqrt(half2);
    start = std::max(from, -half), end = std::min(from + length, half);
    return start < end;
  }

  /// A whole plane, where the point's foot is in the polygon.
  static void addPlane(const Vec3f& normal, float height, float side, float sign, GammaSample& sample) {
    sample.gamma -= side * (1 - Kernel::planeGamma(height));
    sample.gradient += sign * Kernel::planeGammaSlope(height) * normal;
    sample.pairGradient += sign * PairKernel<Kernel>::planeGammaSlope(height) * normal;
  }

  /// What a point sees of a tank's plane through a polygon, where no other plane of the tank comes before.
  static Polygon throughTo(const Polygon& polygon, float facetDistance, std::size_t k,
                           const std::vector<HalfSpace>& tanks) {
    const HalfSpace& tank = tanks[k];
    const float distance = std::max(tank.e, kFacetRounding);
    Polygon seen = polygon;
    // Where the plane is within the support.
    clip(seen, {-tank.normal, -distance * std::abs(facetDistance)});
    for (std::size_t l = 0; l < tanks.size() && !seen.empty(); ++l) {
      if (l == k) continue;
      const Vec3f nearer = tanks[l].normal / std::max(tanks[l].e, kFacetRounding) - tank.normal / distance;
      if (const float length = nearer.norm(); length > 0) clip(seen, {nearer / length, 0});
    }
    for (int corner = 0; corner < seen.count; ++corner) {
      Vec3f& y = seen.corners[static_cast<std::size_t>(corner)];
      y *= distance / std::max(-tank.normal.dot(y), 1e-9F);
    }
    if (facetDistance < 0) std::reverse(seen.corners.begin(), seen.corners.begin() + seen.count);
    return seen;
  }

  std::vector<PolygonEdge> edges_;
  std::vector<EdgeIntegrals> results_;
  std::vector<Owner> owners_;  ///< of the edges
};

}  // namespace migiwa
