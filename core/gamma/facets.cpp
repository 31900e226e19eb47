// gamma of walls made of flat polygons, by sums over their edges. With P(r) = integral_r^h W s^2 ds, the
// field
//   V(y) = -(y - x) P(r) / r^3,   r = |y - x|,
// has the divergence W(r) but at x, and none of it is left at the support radius. So what a solid takes from
// the kernel of a point x outside of it is the flux of V through its facets, their normals n into the fluid:
//   gamma = 1 - sum over facets of integral V . n dA,   grad gamma = sum over facets of n integral W dA.
// The flux through one facet is what the kernel holds in the cone behind it. So the same sum over the facets
// that a point sees, and no others, leaves out all that a thin wall hides; the sides of the cones then belong
// to the border of the fluid as well, and their integrals to the gradient. Between two cones they cancel.
//
// The integrals over a facet at height d over the point, in polar coordinates about the foot of the point,
//   integral V . n dA = closed integral of d [Phi(d) - Phi(r)] dangle,   Phi(r) = integral_r^h P / s^2 ds,
//   integral W dA     = closed integral of [K(d) - K(r)] dangle,         K(r) = integral_r^h W s ds,
// run along its edges as well (facets_simd.cpp); d Phi(d) and K(d) over a full turn are the closed forms of a
// plane. The side of a cone is a plane through the point: integral K(r) dangle.
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "core/gamma/gamma_method.h"
#include "core/gamma/half_spaces.h"
#include "core/gamma/polygon_sums.h"
#include "core/sph/kernels.h"
#include "core/walls/surface.h"

namespace migiwa {

namespace {

/// A facet as a point at the origin sees it; lengths over the support radius.
struct Facet {
  Polygon polygon;
  Vec3f normal;    ///< unit, into the fluid
  float distance;  ///< of the point to the plane, negative behind it
  bool hides;      ///< what lies behind it does not count
  bool alone;      ///< stands before no other facet of its wall
  std::size_t wall;
  bool shaded = false;  ///< others may hide some of it
  bool open = false;    ///< it and others do not close around a solid

  bool front() const { return distance >= 0; }
  /// Whether the point's foot lies in the facet, or so near to it.
  bool within(float slack) const {
    for (int k = 0; k < polygon.count; ++k) {
      const Vec3f& a = polygon.corner(k);
      const Vec3f inwards = normal.cross(polygon.corner(k + 1) - a);
      if (-a.dot(inwards) < -slack * inwards.norm()) return false;
    }
    return true;
  }
  /// Whether it faces the point, and hides what is behind it.
  bool shades() const { return hides && front(); }
  /// Whether the point is in its plane, as good as: it is seen edge-on, and what is behind it past its edges.
  bool edgeOn() const { return distance < kOnFacet && !within(0); }
};

/// A cone about the point that holds a facet.
struct Cone {
  std::size_t facet;
  Vec3f axis;          ///< unit
  float cosine, sine;  ///< of half its angle

  Cone(const Polygon& polygon, std::size_t at) : facet(at), axis(Vec3f::Zero()), cosine(1) {
    for (int k = 0; k < polygon.count; ++k) axis += polygon.corner(k);
    axis.normalize();
    for (int k = 0; k < polygon.count; ++k)
      cosine = std::min(cosine, axis.dot(polygon.corner(k)) / polygon.corner(k).norm());
    cosine -= kFacetRounding;
    sine = std::sqrt(std::max(1 - cosine * cosine, 0.0F));
  }
  /// Whether no direction is in both.
  bool apartFrom(const Cone& other) const {
    return sine * other.cosine + cosine * other.sine > 0 &&
           axis.dot(other.axis) < cosine * other.cosine - sine * other.sine;
  }
};

/// Whether a polygon's plane is in reach at `distance`, but the polygon itself is not.
bool outOfReach(const Polygon& polygon, const Vec3f& normal, float distance) {
  const float reach2 = 1 - distance * distance;
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3f& a = polygon.corner(k);
    const Vec3f way = polygon.corner(k + 1) - a;
    const float outside = a.dot(normal.cross(way));
    if (outside > 0 && outside * outside >= reach2 * way.squaredNorm()) return true;
  }
  return false;
}

/// Whether some of `other` may be behind `facet`, as the point sees it.
bool mayShade(const Facet& facet, const Facet& other, bool first) {
  const auto within = [](const Facet& of, const Vec3f& corner) {
    return of.normal.dot(corner) + of.distance;
  };
  bool behind = false, before = false;
  for (int k = 0; k < other.polygon.count; ++k) {
    const float height = within(facet, other.polygon.corner(k));
    behind = behind || height < -kFacetRounding;
    before = before || height > kFacetRounding;
  }
  // Of two in one plane, the first counts.
  if (!behind && (before || !first)) return false;
  if (behind) {
    const float side = other.front() ? 1.0F : -1.0F;
    bool nearer = false;
    for (int k = 0; k < facet.polygon.count; ++k)
      nearer = nearer || side * within(other, facet.polygon.corner(k)) > kFacetRounding;
    if (!nearer) return false;
  }
  // Nor where one of its edges, as the point sees it, keeps them apart.
  for (int k = 0; k < facet.polygon.count; ++k) {
    const Vec3f outwards = facet.polygon.corner(k).cross(facet.polygon.corner(k + 1));
    bool apart = outwards.squaredNorm() > 1e-18F;  // one that points at the point keeps nothing apart
    for (int l = 0; l < other.polygon.count; ++l) apart = apart && outwards.dot(other.polygon.corner(l)) >= 0;
    if (apart) return false;
  }
  return true;
}

template <class Kernel>
class FacetsGamma final : public GammaMethod {
 public:
  explicit FacetsGamma(const GammaContext& context)
      : boundary_(context.boundary), kernel_(context.kernel), support_(context.supportRadius) {}

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    measure(boundary_, points, out);
    evaluateMeasured(points, out);
  }

  void evaluateMeasured(std::span<const Float4> points, std::span<GammaSample> out) const override {
    thread_local Scratch scratch;
    scratch.sums.clear();
    scratch.moved.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      GammaSample& sample = out[i];
      if (sample.distance >= support_) continue;
      Vec3f p = points[i].xyz();
      // A point behind a wall is taken at the wall, and gamma continued linearly.
      Vec3f moved = Vec3f::Zero();
      if (sample.distance < 0) {
        Vec3f normal;
        moved = boundary_.distance(p, normal) * normal;
        p -= moved;
        moved /= support_;
      }
      look(p, scratch);
      if (sample.distance < kClearOfFacets * support_) {
        moved -= keepOff(scratch);
        scratch.moved.push_back({i, moved});
      }
      scratch.sums.addTanks(i, scratch.tanks, sample);
      addFacets(i, scratch, sample);
    }
    scratch.sums.finish(kernel_, out);
    for (const auto& [at, by] : scratch.moved) out[at].gamma += out[at].gradient.dot(by);
    for (GammaSample& sample : out) range_.set(sample, sample.gamma);
  }

 private:
  struct Scratch {
    PolygonSums<Kernel> sums;
    std::vector<std::pair<std::size_t, Vec3f>> moved;  ///< samples, and how far from where they were taken
    // Of one point:
    std::vector<HalfSpace> tanks;
    std::vector<Facet> facets;
    std::vector<Cone> shades;  ///< about those that hide what is behind them
    std::vector<Polygon> pieces, after;
    std::vector<WallFacet> wall;
    std::vector<WallPiece> planes;
  };

  /// Collects the facets and half-spaces in reach of p.
  void look(const Vec3f& p, Scratch& scratch) const {
    const float inverse = 1 / support_;
    scratch.tanks.clear();
    scratch.facets.clear();
    for (const Surface* surface : boundary_.near(p, support_)) {
      if (!surface->faceted()) {
        scratch.planes.clear();
        surface->pieces(p, support_, scratch.planes);
        for (const WallPiece& piece : scratch.planes)
          intersect(scratch.tanks, {piece.normal, std::max(piece.planeDistance * inverse, 0.0F)});
        continue;
      }
      scratch.wall.clear();
      surface->facets(p, support_, scratch.wall);
      const std::size_t first = scratch.facets.size();
      bool passable = false;
      for (const WallFacet& facet : scratch.wall) {
        const float distance = inverse * facet.normal.dot(p - facet.corners[0]);
        if (std::abs(distance) >= 1) continue;
        Facet& added = scratch.facets.emplace_back();
        added.normal = facet.normal;
        added.distance = distance < -kOnFacet ? distance : std::max(distance, 0.0F);
        added.hides = facet.hides;
        added.alone = facet.alone;
        added.wall = first;
        for (int k = 0; k < facet.count; ++k)
          added.polygon.add(inverse * (facet.corners[static_cast<std::size_t>(k)] - p));
        if (outOfReach(added.polygon, added.normal, added.distance)) {
          scratch.facets.pop_back();
          continue;
        }
        passable = passable || (added.front() && !added.hides);
      }
      if (passable) continue;
      // Nothing comes out again behind what hides.
      scratch.facets.erase(
          std::remove_if(scratch.facets.begin() + static_cast<std::ptrdiff_t>(first), scratch.facets.end(),
                         [](const Facet& facet) { return !facet.front(); }),
          scratch.facets.end());
    }
  }

  /// Moves the point off all that it touches, and returns how far.
  static Vec3f keepOff(Scratch& scratch) {
    Vec3f away = Vec3f::Zero();
    for (const HalfSpace& tank : scratch.tanks)
      if (tank.e < kClearOfFacets) away += kClearOfFacets * tank.normal;
    for (const Facet& facet : scratch.facets)
      if (facet.front() && facet.distance < kClearOfFacets && facet.within(kClearOfFacets))
        away += kClearOfFacets * facet.normal;
    for (HalfSpace& tank : scratch.tanks) tank.e = std::max(tank.e + away.dot(tank.normal), 0.0F);
    for (Facet& facet : scratch.facets) {
      const float distance = facet.distance + away.dot(facet.normal);
      facet.distance = facet.front() ? std::max(distance, 0.0F) : distance;
      for (int k = 0; k < facet.polygon.count; ++k)
        facet.polygon.corners[static_cast<std::size_t>(k)] -= away;
    }
    return away;
  }

  void addFacets(std::size_t i, Scratch& scratch, GammaSample& sample) const {
    std::vector<Facet>& facets = scratch.facets;
    for (Facet& facet : facets) {
      for (const HalfSpace& tank : scratch.tanks) clip(facet.polygon, {tank.normal, tank.e});
    }
    scratch.shades.clear();
    const bool oneWall = std::all_of(facets.begin(), facets.end(), [&](const Facet& facet) {
      return facet.wall == facets.front().wall && facet.front();
    });
    for (std::size_t k = 0; k < facets.size(); ++k)
      if (facets[k].shades() && !facets[k].edgeOn() && !facets[k].polygon.empty() &&
          !(oneWall && facets[k].alone))
        scratch.shades.emplace_back(facets[k].polygon, k);
    for (std::size_t k = 0; k < facets.size(); ++k)
      facets[k].shaded = anyShade(k, scratch, [](const Facet&) { return true; });
    // What hides something, or is hidden in part, ends in the sides of cones, and so does the rest of its
    // wall.
    for (std::size_t first = 0, end = 0; first < facets.size(); first = end) {
      bool open = false;
      for (end = first; end < facets.size() && facets[end].wall == facets[first].wall; ++end)
        open = open || facets[end].shades() || facets[end].shaded;
      for (std::size_t k = first; k < end; ++k) facets[k].open = open;
    }
    for (std::size_t k = 0; k < facets.size(); ++k) {
      if (facets[k].polygon.empty()) continue;
      if (facets[k].shaded) {
        leaveSeen(k, scratch);
        for (const Polygon& piece : scratch.pieces) addPiece(i, facets[k], piece, scratch, sample);
      } else {
        addPiece(i, facets[k], facets[k].polygon, scratch, sample);
      }
    }
  }

  /// Calls visit(shade) for the facets that may hide some of facet k, until it returns true. Returns whether
  /// it did.
  template <class Visit>
  static bool anyShade(std::size_t k, const Scratch& scratch, const Visit& visit) {
    const Facet& facet = scratch.facets[k];
    if (facet.polygon.empty() || scratch.shades.empty()) return false;
    const Cone own(facet.polygon, k);
    for (const Cone& cone : scratch.shades) {
      if (cone.facet == k || cone.apartFrom(own)) continue;
      const Facet& shade = scratch.facets[cone.facet];
      if (shade.wall == facet.wall && shade.alone && facet.front()) continue;
      if (mayShade(shade, facet, cone.facet < k) && visit(shade)) return true;
    }
    return false;
  }

  /// The pieces that others leave of a facet.
  static void leaveSeen(std::size_t k, Scratch& scratch) {
    scratch.pieces.assign(1, scratch.facets[k].polygon);
    anyShade(k, scratch, [&scratch](const Facet& shade) {
      const ViewCone cone(shade.polygon, shade.normal, shade.distance);
      scratch.after.clear();
      for (const Polygon& polygon : scratch.pieces)
        if (!cone.subtractFrom(polygon, scratch.after)) scratch.after.push_back(polygon);
      std::swap(scratch.pieces, scratch.after);
      return scratch.pieces.empty();
    });
  }

  /// What is behind a part of a facet, as far as the half-spaces reach.
  static void addPiece(std::size_t i, const Facet& facet, const Polygon& polygon, Scratch& scratch,
                       GammaSample& sample) {
    if (scratch.sums.add(i, polygon, facet.normal, facet.distance, 1, facet.open, sample))
      scratch.sums.addBehind(i, polygon, facet.distance, facet.open, scratch.tanks, sample);
  }

  const Boundary& boundary_;
  KernelType kernel_;
  float support_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeFacetsGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<FacetsGamma<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
