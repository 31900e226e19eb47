// Triangles as walls: a search among them, their union's outer faces, and rays to them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/math.h"
#include "core/slim/points.h"
#include "core/walls/surface.h"

namespace migiwa {

// A wall as the flat pieces that it is made of.

struct WallTriangle {
  std::array<Vec3f, 3> corners;  ///< (m), counter-clockwise seen from the fluid
  Vec3f normal;                  ///< unit, into the fluid
  bool sheet = false;            ///< of an open surface: fluid on both sides, and no solid
  std::uint32_t face = 0;        ///< of the mesh that it is, or a part of
};

// A tree of boxes over triangles: its cost grows with the logarithm of their number.

class TriangleTree {
 public:
  explicit TriangleTree(std::vector<WallTriangle> triangles);

  const std::vector<WallTriangle>& triangles() const { return triangles_; }
  const Bounds& bounds() const { return bounds_; }

  /// The wall as a point sees it. Signed distance (m): negative in the solid; never on sheets.
  struct Nearest {
    float distance;
    Vec3f normal;  ///< unit, from the wall to the point, or of the wall where the point lies on it
  };
  /// There must be a triangle. At edges and corners the side is that of the mean normal of the triangles that
  /// meet there, weighted by their angles (Baerentzen and Aanaes 2005).
  Nearest nearest(const Vec3f& p) const;
  /// Distance (m) from p to one triangle.
  float distanceTo(std::uint32_t index, const Vec3f& p) const;

  /// Calls visit(index) for the triangles whose boxes come nearer than `reach` (m) to p, until it returns
  /// true. Returns whether it did.
  template <class Visit>
  bool visitWithin(const Vec3f& p, float reach, const Visit& visit) const {
    return visitWhere([&](const Branch& b) { return squaredDistance(b, p) < reach * reach; }, visit);
  }
  /// Calls visit(index) for those whose boxes overlap one with these corners (m).
  template <class Visit>
  bool visitBox(const Vec3f& low, const Vec3f& high, const Visit& visit) const {
    return visitWhere(
        [&](const Branch& b) {
          return (b.low.array() <= high.array()).all() && (b.high.array() >= low.array()).all();
        },
        visit);
  }
  /// Calls visit(index) for those whose boxes the straight way between two points meets.
  template <class Visit>
  bool visitWay(const Vec3f& from, const Vec3f& to, const Visit& visit) const {
    const Vec3f inverse = (to - from).cwiseInverse();
    return visitWhere([&](const Branch& b) { return meets(b, from, inverse); }, visit);
  }

 private:
  struct Branch {
    Vec3f low, high;           ///< box of the triangles below
    std::uint32_t begin, end;  ///< triangles below
    std::uint32_t right;       ///< second child; the first one follows; 0: a leaf
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end);
  static float squaredDistance(const Branch& branch, const Vec3f& p) {
    return (p.cwiseMax(branch.low).cwiseMin(branch.high) - p).squaredNorm();
  }
  static bool meets(const Branch& branch, const Vec3f& from, const Vec3f& inverse);
  Vec3f meanNormal(const Vec3f& foot) const;
  /// Positive where p = foot + way, whose nearest place is `foot` on the border of a triangle that is no
  /// sheet, is on the side that normals point to.
  float sideAt(const WallTriangle& triangle, const Vec3f& foot, const Vec3f& way) const;

  template <class Wanted, class Visit>
  bool visitWhere(const Wanted& wanted, const Visit& visit) const {
    std::uint32_t stack[64];
    int depth = 0;
    if (!branches_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t at = stack[--depth];
      const Branch& branch = branches_[at];
      if (!wanted(branch)) continue;
      if (branch.right != 0) {
        stack[depth++] = branch.right;
        stack[depth++] = at + 1;
      } else {
        for (std::uint32_t k = branch.begin; k < branch.end; ++k) {
          if constexpr (std::is_same_v<decltype(visit(k)), bool>) {
            if (visit(k)) return true;
          } else {
            visit(k);
          }
        }
      }
    }
    return false;
  }

  std::vector<WallTriangle> triangles_;
  std::vector<Branch> branches_;
  Bounds bounds_;
  float rounding_ = 0;  ///< within which two places are one (m)
};

/// Where the straight way from one point to another meets the triangle, as a part of the way in [0, 1];
/// negative where it does not. What meets an edge meets the triangles on both of its sides.
float meetingOf(const WallTriangle& triangle, const Vec3f& from, const Vec3f& to);

// The faces of a mesh that are walls. What is inside a mesh is where its winding number is 1 or more: parts
// may overlap, touch, lie within each other, or be turned inwards to hollow others out. Faces with the same
// on both sides are no walls; of faces that others cross only a part is.

/// Triangles with the fluid on the outside of a mesh or, if `fluidInside`, on its inside. Parts of the mesh
/// that are open are sheets: what lies in the solid of the others is left out. Their corners are those of the
/// mesh, or lie where its faces cross to a millionth of its size. Throws InputError, at `place`, where so
/// many faces cross that their pieces are more than a wall can have.
std::vector<WallTriangle> wallFaces(const TriangleMesh& mesh, bool fluidInside, const std::string& place);

// First hits of rays from one point with triangles.

/// A triangle as seen from a point.
struct SeenTriangle {
  Vec3f inverse;               ///< along direction w the plane is 1 / (w . inverse) away (m)
  std::array<Vec3f, 3> sides;  ///< w . side >= 0 for all three where the ray passes through the triangle
  Vec3f axis;                  ///< unit, of a cone that holds the triangle
  float cosine;                ///< of the angle between the axis and the cone
};
/// From `origin`, which lies on the side that the normal points to or, if `behind`, on the other one.
SeenTriangle seenFrom(const Vec3f& origin, const WallTriangle& triangle, bool behind);

/// hits[k] becomes the distance (m) along direction k to the first of the triangles, where that is less.
void hitTriangles(std::span<const SeenTriangle> triangles, const Directions& directions,
                  std::span<float> hits);

}  // namespace migiwa
