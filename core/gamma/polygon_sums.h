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
/// Of the support radius: an edge is none that is shorter.
inline constexpr float kShortEdge = 1e-7F;
/// Of the support radius: from a corner or an edge no facet is seen, so that much a point is kept off walls.
inline constexpr float kClearOfFacets = 1e-4F;

// Lengths are over the support radius, and places relative to the point.

template <class Kernel>
class PolygonSums {
 public:
  void clear() { count_ = 0; }

  /// Adds `sign` times the integrals over a polygon in a plane at `distance` to sample `i`, which is
  /// `sample`; and, if `open`, those over the sides of the cone behind it. False where it is out of reach.
  bool add(std::size_t i, const Polygon& polygon, const Vec3f& normal, float distance, float sign, bool open,
           GammaSample& sample) {
    const float height = std::abs(distance), side = distance < 0 ? -sign : sign;
    makeRoom(2 * static_cast<std::size_t>(polygon.count));
    const std::size_t before = count_;
    bool within = true;
    for (int k = 0; k < polygon.count; ++k) {
      const Vec3f &a = polygon.corner(k), way = polygon.corner(k + 1) - a;
      const float length = way.norm();
      if (length < kShortEdge) continue;
      const Vec3f along = way / length, inwards = normal.cross(along);
      const float inside = -a.dot(inwards), from = a.dot(along);
      const float half2 = 1 - height * height - inside * inside;
      if (inside < 0) {
        within = false;
        if (half2 <= 0) {
          count_ = before;
          return false;
        }
      }
      float start = 0, end = 0;
      if (!endsOf(from, length, half2, start, end)) continue;
      put({height, inside, start, end}, {i, side, sign * normal});
      if (!open) continue;
      const float least = std::sqrt(1 - half2);
      if (least < kFacetRounding) continue;
      put({0, least, start, end}, {i, 0, sign / least * (distance * inwards - inside * normal)});
    }
    if (within) addPlane(normal, height, side, sign, sample);
    return true;
  }

  /// The same, open and in front of the point, for the face across an axis of an upright block from `low` to
  /// `high`, no edge of which is short; `side`: 1 for the upper one, -1.
  bool addFace(std::size_t i, const Vec3f& low, const Vec3f& high, int axis, float side, float distance,
               GammaSample& sample) {
    // The edges counter-clockwise as the point sees them, all four at a time.
    const int one = (axis + (side > 0 ? 1 : 2)) % 3, other = (axis + (side > 0 ? 2 : 1)) % 3;
    const float longOne = high[one] - low[one], longOther = high[other] - low[other];
    const Quad insides(-low[other], high[one], high[other], -low[one]),
        froms(low[one], low[other], -high[one], -high[other]),
        lengths(longOne, longOther, longOne, longOther);
    const Quad half2 = 1 - distance * distance - insides * insides;
    const bool within = insides.minCoeff() >= 0;
    if (!within) {
      for (int k = 0; k < 4; ++k)
        if (insides[k] < 0 && half2[k] <= 0) return false;
    }
    const Quad half = roots(half2.max(0.0F)), leasts = roots(1 - half2);
    const Quad starts = froms.max(-half), ends = (froms + lengths).min(half);
    const int across[4] = {other, one, other, one};
    const float inwards[4] = {1, -1, -1, 1};
    makeRoom(8);
    Vec3f normal = Vec3f::Zero();
    normal[axis] = side;
    for (int k = 0; k < 4; ++k) {
      if (!(half2[k] > 0 && starts[k] < ends[k])) continue;
      put({distance, insides[k], starts[k], ends[k]}, {i, 1, normal});
      if (leasts[k] < kFacetRounding) continue;
      Vec3f cone = Vec3f::Zero();
      cone[axis] = 1 / leasts[k] * -(insides[k] * side);
      cone[across[k]] = 1 / leasts[k] * (distance * inwards[k]);
      put({0, leasts[k], starts[k], ends[k]}, {i, 0, cone});
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

  /// A whole plane, where the point's foot is in the polygon.
  static void addPlane(const Vec3f& normal, float height, float side, float sign, GammaSample& sample) {
    sample.gamma -= side * (1 - Kernel::planeGamma(height));
    sample.gradient += sign * Kernel::planeGammaSlope(height) * normal;
    sample.pairGradient += sign * PairKernel<Kernel>::planeGammaSlope(height) * normal;
  }

  /// Integrates along all edges, and adds what that gives to the samples.
  void finish(KernelType kernel, std::span<GammaSample> samples) {
    // Filled up to whole vectors by edges without length.
    const std::size_t filled = (count_ + kEdgeGroup - 1) / kEdgeGroup * kEdgeGroup;
    makeRoom(filled - count_);
    std::fill(edges_.data() + count_, edges_.data() + filled, PolygonEdge{});
    integrate(kernel, std::span(edges_).first(filled), std::span(results_).first(filled));
    for (std::size_t k = 0; k < count_; ++k) {
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

  /// A value of each edge of a rectangle.
  using Quad = Eigen::Array4f;

  /// Exact; those of Eigen are not the same on all processors.
  static Quad roots(const Quad& of) {
    return {std::sqrt(of[0]), std::sqrt(of[1]), std::sqrt(of[2]), std::sqrt(of[3])};
  }

  /// For so many more edges.
  void makeRoom(std::size_t more) {
    if (count_ + more <= edges_.size()) return;
    const std::size_t size = 2 * (count_ + more + kEdgeGroup);
    edges_.resize(size), owners_.resize(size), results_.resize(size);
  }
  void put(const PolygonEdge& edge, const Owner& owner) {
    edges_[count_] = edge;
    owners_[count_++] = owner;
  }

  /// Where an edge is in the support, half2 the squared half of its line there. False where it is not.
  static bool endsOf(float from, float length, float half2, float& start, float& end) {
    if (half2 <= 0) return false;
    const float half = std::sqrt(half2);
    start = std::max(from, -half), end = std::min(from + length, half);
    return start < end;
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

  // As long as they have ever been; the first count_ are there.
  std::size_t count_ = 0;
  std::vector<PolygonEdge> edges_;
  std::vector<EdgeIntegrals> results_;
  std::vector<Owner> owners_;  ///< of the edges
};

}  // namespace migiwa
