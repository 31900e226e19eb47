// The planar pieces in reach of a point, sorted by how they combine: those of all concave surfaces bound the
// fluid together, those of each convex solid bound that solid.
#pragma once

#include <span>
#include <vector>

#include "core/boundary/boundary.h"

namespace migiwa {

struct WallPieces {
  std::vector<WallPiece> concave;
  std::vector<WallPiece> convex;        ///< of all convex solids, one after another
  std::vector<std::size_t> convexEnds;  ///< one past each convex solid's last piece

  void collect(const Boundary& boundary, const Vec3f& p, float reach);
  bool empty() const { return concave.empty() && convex.empty(); }

  template <class Body>
  void forEachConvexSolid(const Body& body) const {
    std::size_t begin = 0;
    for (const std::size_t end : convexEnds) {
      body(std::span(convex).subspan(begin, end - begin));
      begin = end;
    }
  }
};

}  // namespace migiwa
