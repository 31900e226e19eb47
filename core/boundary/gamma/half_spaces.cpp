#include "core/boundary/gamma/half_spaces.h"

#include <algorithm>
#include <limits>

namespace migiwa {

namespace {

/// Of a block, takes out the faces behind those that the point sees, or behind the nearest from inside.
void dropHidden(std::vector<WallPiece>& faces) {
  float nearest = -std::numeric_limits<float>::infinity();
  for (const WallPiece& face : faces) nearest = std::max(nearest, face.planeDistance);
  const float seen = std::min(nearest, 0.0F);
  const std::vector<WallPiece> all = faces;
  std::erase_if(faces, [&](const WallPiece& hidden) {
    return std::any_of(all.begin(), all.end(), [&](const WallPiece& face) {
      return face.planeDistance >= seen && face.planeDistance > hidden.planeDistance &&
             face.normal.dot(hidden.normal) < -0.999F;
    });
  });
}

}  // namespace

bool intersect(std::vector<HalfSpace>& set, const HalfSpace& added) {
  for (HalfSpace& known : set) {
    if (known.normal.dot(added.normal) <= 0.999F) continue;
    // Faces meant to lie in one plane differ by rounding.
    const bool narrower = added.e < known.e - 1e-4F;
    if (added.e < known.e) known = added;
    return narrower;
  }
  set.push_back(added);
  return true;
}

void HalfSpaces::addBlock(bool thin, float inverseSupport) {
  if (thin) dropHidden(pieces_);
  std::vector<HalfSpace>& block = blocks.emplace_back(tanks);
  std::vector<float> own;
  for (const WallPiece& piece : pieces_) {
    const HalfSpace behind{-piece.normal, -piece.planeDistance * inverseSupport};
    if (intersect(block, behind)) own.push_back(behind.e);
  }
  if (!thin) return;
  // An edge of the block is as near as its two faces together.
  for (std::size_t k = 0; k < own.size(); ++k)
    for (std::size_t l = 0; l < k; ++l) thinRim = thinRim || own[k] * own[k] + own[l] * own[l] < 1;
}

void HalfSpaces::collect(const Boundary& boundary, const Vec3f& p, float supportRadius) {
  tanks.clear();
  blocks.clear();
  thinRim = false;
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
    if (!pieces_.empty()) addBlock(surface->thickness() < supportRadius, inverse);
  }
}

}  // namespace migiwa
