#include "core/boundary/gamma/wall_pieces.h"

namespace migiwa {

void WallPieces::collect(const Boundary& boundary, const Vec3f& p, float reach) {
  concave.clear();
  convex.clear();
  convexEnds.clear();
  for (const auto& surface : boundary.surfaces()) {
    if (surface->pieceRule() == PieceRule::fluidInsideAll) {
      surface->pieces(p, reach, concave);
    } else {
      const std::size_t before = convex.size();
      surface->pieces(p, reach, convex);
      if (convex.size() > before) convexEnds.push_back(convex.size());
    }
  }
}

}  // namespace migiwa
