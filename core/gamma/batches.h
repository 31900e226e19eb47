// Gamma of many points at once, with the vector instructions of the processor at hand.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/gamma/gamma_method.h"
#include "core/gamma/half_spaces.h"
#include "core/sph/kernels.h"
#include "core/walls/surface.h"

namespace migiwa {

/// Begins samples anew, with the distances (m) of their points.
inline void measure(const Boundary& boundary, std::span<const Float4> points, std::span<GammaSample> out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    out[i] = GammaSample{};
    out[i].distance = boundary.distance(points[i].xyz());
  }
}

// The product over planes for many points at once, with the vector instructions of the processor at hand.

/// gamma as the product over the planes' axes. Distances are those to the planes: behind two of them they are
/// too short.
void productOfPlanes(const FlatPlanes& walls, KernelType kernel, float supportRadius,
                     std::span<const Float4> points, std::span<GammaSample> out);

// Sums over fixed directions of what a kernel holds up to the first wall, with the vector instructions of the
// processor at hand. The order of the sum depends on the width of its vectors, so processors agree within
// rounding.

/// Directions that are summed eight at a time: neighbours look nearly the same way, and there is no rest.
Directions groupedDirections(int count);

/// Sums of G(r) and of (H(r) - H(1)) w, for the density kernel and for the kernel of the pair gradients.
struct RaySums {
  float mass = 0;
  Vec3f slope = Vec3f::Zero(), pairSlope = Vec3f::Zero();
};

/// Adds `sign` times what the rays hold up to `hits` (m).
void addRays(KernelType kernel, const Directions& directions, std::span<const float> hits,
             float supportRadius, float sign, RaySums& sums);

/// What the rays hold up to the first of the planes, less what they hold up to the first plane alone: the
/// rest that directions add to a closed form. A point behind a plane is taken to lie on it. At most
/// kMostRayPlanes of them.
inline constexpr std::size_t kMostRayPlanes = 64;
RaySums beyondFirstPlane(KernelType kernel, const Directions& directions, std::span<const HalfSpace> planes);

// Integrals along the edges of flat polygons, which are what the polygons' own integrals are made of
// (facets.cpp has the equations), with the vector instructions of the processor at hand.

/// Lengths over the support radius; an edge ends where it leaves the support.
struct PolygonEdge {
  float height;    ///< of the point over the polygon's plane, >= 0
  float inside;    ///< distance of the point's foot to the edge's line, positive inside
  float from, to;  ///< ends along the edge, from the point of its line that is nearest
};
struct EdgeIntegrals {
  float flux;            ///< integral of height Phi(r) over the angle about the foot
  float area, pairArea;  ///< integral of K(r) over the angle
  float unused;
};
/// So many edges are taken at once.
inline constexpr std::size_t kEdgeGroup = 8;
/// Fills one result for each edge, of whole groups.
void integrate(KernelType kernel, std::span<const PolygonEdge> edges, std::span<EdgeIntegrals> results);

/// A face of an upright block that faces a point, seen from there; lengths over the support radius. Its edges
/// go first along the axis after its own (before it, on the lower side), then along the other.
struct UprightFace {
  float distance;  ///< of the point to its plane, in [0, 1)
  float side;      ///< 1: it looks up its axis, -1: down
  float axis;      ///< 0, 1, 2
  float firstLow, firstHigh, otherLow, otherHigh;
};
/// The faces that the point of a sample sees: `count` from `first` on.
struct FacesSeen {
  std::uint32_t sample, first, count;
};
/// Adds the integrals along their edges and those of the cones behind them to the samples. `points` with more
/// faces come first.
void addUprightFaces(KernelType kernel, std::span<const UprightFace> faces, std::span<const FacesSeen> points,
                     std::span<GammaSample> samples);

/// Of the support radius: nearer than that to a plane, a corner of another facet lies on it.
inline constexpr float kFacetRounding = 1e-5F;

// gamma about thin upright blocks that stand apart as a point sees them: the sums of facets.cpp, without its
// search for what hides what.

class BlockGamma {
 public:
  BlockGamma() = default;
  virtual ~BlockGamma() = default;
  BlockGamma(const BlockGamma&) = delete;
  BlockGamma& operator=(const BlockGamma&) = delete;

  /// Fills out[i] for points[i] where it can; elsewhere the distance alone, and i is appended to `others`.
  virtual void evaluate(std::span<const Float4> points, std::span<GammaSample> out,
                        std::vector<std::size_t>& others) const = 0;
  /// As of a GammaMethod.
  virtual long takeOutOfRange() const = 0;
};

/// Null where no wall is such a block.
std::unique_ptr<BlockGamma> makeBlockGamma(const GammaContext& context);

}  // namespace migiwa
