#include "core/gamma/half_spaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace migiwa {

namespace {

/// Of a block, takes out the faces behind those visible from the point, or behind the nearest from inside.
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

bool HalfSpaces::addBlock(bool thin, float inverseSupport) {
  if (thin) dropHidden(pieces_);
  if (count_ == blocks_.size()) blocks_.emplace_back();
  std::vector<HalfSpace>& block = blocks_[count_++];
  block = tanks_;
  own_.clear();
  for (const WallPiece& piece : pieces_) {
    const HalfSpace behind{-piece.normal, -piece.planeDistance * inverseSupport};
    if (intersect(block, behind)) own_.push_back(behind.e);
  }
  if (!thin) return false;
  // An edge of the block is as near as its two faces together.
  for (std::size_t k = 0; k < own_.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (own_[k] * own_[k] + own_[l] * own_[l] < 1) return true;
  return false;
}

bool HalfSpaces::collect(const Boundary& boundary, const Vec3f& p, float supportRadius, bool untilRim) {
  tanks_.clear();
  count_ = 0;
  bool thinRim = false;
  const float inverse = 1 / supportRadius;
  const NearWalls near = boundary.near(p, supportRadius);
  for (const Surface* surface : near) {
    if (surface->pieceRule() != PieceRule::fluidInsideAll) continue;
    pieces_.clear();
    surface->pieces(p, supportRadius, pieces_);
    for (const WallPiece& piece : pieces_) intersect(tanks_, {piece.normal, piece.planeDistance * inverse});
  }
  for (const Surface* surface : near) {
    if (surface->pieceRule() != PieceRule::solidInsideAll) continue;
    pieces_.clear();
    surface->pieces(p, supportRadius, pieces_);
    if (pieces_.empty()) continue;
    thinRim = addBlock(surface->thickness() < supportRadius, inverse) || thinRim;
    if (thinRim && untilRim) break;
  }
  return thinRim;
}

std::optional<FlatPlanes> FlatPlanes::of(const Boundary& boundary, float supportRadius) {
  const auto& surfaces = boundary.surfaces();
  if (surfaces.empty() || !std::all_of(surfaces.begin(), surfaces.end(), [](const auto& surface) {
        return surface->planar() && surface->pieceRule() == PieceRule::fluidInsideAll;
      }))
    return std::nullopt;
  std::vector<WallPiece> pieces;
  for (const auto& surface : surfaces)
    surface->pieces(Vec3f::Zero(), std::numeric_limits<float>::infinity(), pieces);

  if (pieces.size() > kMostPlanes) return std::nullopt;

  FlatPlanes flat;
  const float inverse = 1 / supportRadius;
  for (const WallPiece& piece : pieces) {
    const FlatPlane plane{piece.normal * inverse, piece.planeDistance * inverse, piece.normal};
    bool merged = false;
    for (FlatPlane& known : flat.planes_) {
      const float cosine = known.unit.dot(plane.unit);
      if (cosine <= 0.999F) continue;
      if ((known.unit - plane.unit).norm() > 1e-5F) return std::nullopt;
      if (plane.offset < known.offset) known = plane;
      merged = true;
    }
    if (!merged) flat.planes_.push_back(plane);
  }
  const auto cosineOf = [&](int a, int b) {
    return flat.planes_[static_cast<std::size_t>(a)].unit.dot(flat.planes_[static_cast<std::size_t>(b)].unit);
  };
  for (int k = 0; k < static_cast<int>(flat.planes_.size()); ++k) {
    const auto opposite = std::find_if(flat.axes_.begin(), flat.axes_.end(), [&](const Axis& axis) {
      return axis.second < 0 && cosineOf(axis.first, k) < -0.999F;
    });
    if (opposite != flat.axes_.end()) {
      opposite->second = k;
    } else {
      flat.axes_.push_back({k, -1});
    }
    for (int other = 0; other < k; ++other)
      if (const float cosine = std::abs(cosineOf(other, k)); cosine >= 1e-3F && cosine <= 0.999F)
        flat.oblique_.emplace_back(other, k);
  }
  return flat;
}

bool FlatPlanes::obliqueAt(const Vec3f& p) const {
  return std::any_of(oblique_.begin(), oblique_.end(), [&](const auto& pair) {
    return planes_[static_cast<std::size_t>(pair.first)].at(p) < 1 &&
           planes_[static_cast<std::size_t>(pair.second)].at(p) < 1;
  });
}

void FlatPlanes::inReach(const Vec3f& p, std::vector<HalfSpace>& set) const {
  set.clear();
  for (const FlatPlane& plane : planes_)
    if (const float e = plane.at(p); e < 1) set.push_back({plane.unit, e});
}

}  // namespace migiwa
