#include "core/boundary/gamma/half_spaces.h"

#include <algorithm>

namespace migiwa {

void intersect(std::vector<HalfSpace>& set, const HalfSpace& added) {
  for (HalfSpace& known : set) {
    if (known.normal.dot(added.normal) > 0.999F) {
      if (added.e < known.e) known = added;
      return;
    }
  }
  set.push_back(added);
}

void HalfSpaces::collect(const Boundary& boundary, const Vec3f& p, float supportRadius) {
  tanks.clear();
  blocks.clear();
  const float inverse = 1 / supportRadius;
  for (const auto& surface : boundary.surfaces()) {
    if (surface->pieceRule() != PieceRule::fluidInsideAll) continue;
    pieces_.clear();
    surface->pieces(p, supportRadius, pieces_);
    for (const WallPiece& piece : pieces_) intersect(tanks, {piece.normal, piece.planeDistance * inverse});
  }
  for (const auto& surface : boundary.surfaces()) {
    if (surface->pieceRule() != PieceRule::solidInsideAll) continue;
    pieces_.clear();
    surface->pieces(p, supportRadius, pieces_);
    if (pieces_.empty()) continue;
    std::vector<HalfSpace>& block = blocks.emplace_back(tanks);
    for (const WallPiece& piece : pieces_) intersect(block, {-piece.normal, -piece.planeDistance * inverse});
  }
}

}  // namespace migiwa
