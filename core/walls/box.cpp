#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/walls/shapes.h"
#include "core/walls/surface.h"

namespace migiwa {

Box::Box(const Vec3d& min, const Vec3d& max, Fluid fluid, const Rotation& rotation)
    : min_(min), max_(max), rotation_(rotation), fluid_(fluid) {
  prepare();
}

template <class Visitor>
void Box::fields(Visitor& visitor, Visited<Visitor, Box>& self) {
  visitor.choice("fluid", self.fluid_, kFluidNames,
                 {"", "The side of the wall that holds the fluid.", Presence::required});
  visitor.place("min", self.min_,
                {"m", "Corner with the smallest coordinates, before the rotation.", Presence::required});
  visitor.place("max", self.max_,
                {"m", "Corner with the largest coordinates, before the rotation.", Presence::required});
  visitor.object("rotation", {"", "Turns the box about its centre."},
                 [&](auto& rotation) { Rotation::describe(rotation, self.rotation_); });
}

void Box::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void Box::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (visitor.valid({"min", "max"}) && (max_.array() <= min_.array()).any()) {
    visitor.fault("max", "expected every coordinate to be larger than that of min, found one that is not");
  } else {
    prepare();
  }
}

inline Vec3f Box::toLocal(const Vec3f& p) const {
  return turned_ ? Vec3f(toLocal_ * (p - center_)) : Vec3f(p - center_);
}

inline Vec3f Box::toWorld(const Vec3f& local) const {
  return turned_ ? Vec3f(center_ + toLocal_.transpose() * local) : Vec3f(center_ + local);
}

void Box::prepare() {
  geometry_ = {0.5 * (min_ + max_), rotation_.matrix(), 0.5 * (max_ - min_)};
  center_ = geometry_.center.cast<float>();
  half_ = geometry_.halfExtents.cast<float>();
  toLocal_ = geometry_.axes.transpose().cast<float>();
  turned_ = toLocal_ != Eigen::Matrix3f::Identity();
  for (int index = 0; index < 8; ++index)
    corners_[static_cast<std::size_t>(index)] = corner(index).cast<float>();
  block_.reset();
  vessel_.reset();
  if (turned_) return;
  if (fluid_ == Fluid::inside) {
    vessel_ = UprightVessel{center_, half_};
  } else {
    block_ = UprightBlock{center_, half_, corners_.front(), corners_.back()};
  }
}

float Box::distance(const Vec3f& p, Vec3f& normal) const {
  const Vec3f local = toLocal(p);
  // Per axis: how far beyond (positive) or within (negative) the faces.
  const Vec3f beyond = local.cwiseAbs() - half_;
  Vec3f outward;
  float outside;  // signed distance, positive outside the box
  if (beyond.maxCoeff() > 0) {
    const Vec3f positive = beyond.cwiseMax(0.0F);
    outside = positive.norm();
    outward = positive / outside;
  } else {
    int axis = 0;
    outside = beyond.maxCoeff(&axis);
    outward = Vec3f::Unit(axis);
  }
  for (int axis = 0; axis < 3; ++axis) outward[axis] = std::copysign(outward[axis], local[axis]);
  if (turned_) outward = toLocal_.transpose() * outward;
  normal = fluid_ == Fluid::inside ? Vec3f(-outward) : outward;
  return fluid_ == Fluid::inside ? -outside : outside;
}

bool Box::project(Vec3f& p, float margin) const {
  Vec3f local = toLocal(p);
  const bool moved =
      fluid_ == Fluid::inside ? pullIntoBox(local, half_, margin) : pushOutOfBox(local, half_, margin);
  if (moved) p = toWorld(local);
  return moved;
}

void Box::otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const {
  if (fluid_ == Fluid::inside) return;
  const Vec3f local = toLocal(p);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      Vec3f way = local;
      way[axis] = side * (half_[axis] + margin);
      out.push_back(toWorld(way));
    }
  }
}

void Box::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  const Vec3f local = toLocal(p);
  const Vec3f onBox = local.cwiseMax(-half_).cwiseMin(half_);
  const bool inside = fluid_ == Fluid::inside;
  if (!inside && (local - onBox).squaredNorm() >= reach * reach) return;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const float within = half_[axis] - side * local[axis];  // distance to the face, positive inside the box
      if (std::abs(within) >= reach) continue;
      Vec3f foot = onBox;
      foot[axis] = side * half_[axis];
      const Vec3f outward = side * toLocal_.row(axis).transpose();
      out.push_back({inside ? Vec3f(-outward) : outward, inside ? within : -within, toWorld(foot)});
    }
  }
}

void Box::facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const {
  const Vec3f local = toLocal(p);
  const Vec3f beyond = (local.cwiseAbs() - half_).cwiseMax(0.0F);
  if (beyond.squaredNorm() >= supportRadius * supportRadius) return;
  const bool hides = thickness() < supportRadius;
  for (int axis = 0; axis < 3; ++axis) {
    const int one = (axis + 1) % 3, other = (axis + 2) % 3;
    for (const float side : {-1.0F, 1.0F}) {
      const float above = side * local[axis] - half_[axis];
      if (std::abs(above) >= supportRadius || (hides && above < -0.01F * supportRadius)) continue;
      WallFacet& facet = out.emplace_back();
      facet.count = 4;
      facet.normal = side * toLocal_.row(axis).transpose();
      facet.hides = hides;
      facet.alone = true;
      // Counter-clockwise about the axis, clockwise about its opposite.
      const std::size_t from = side > 0 ? 1U << axis : 0U, a = 1U << (side > 0 ? one : other),
                        b = 1U << (side > 0 ? other : one);
      facet.corners = {corners_[from], corners_[from + a], corners_[from + a + b], corners_[from + b]};
    }
  }
}

void Box::firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const {
  const Vec3f local = toLocal(origin);
  if (fluid_ == Fluid::inside) {
    const float farthest = *std::max_element(hits.begin(), hits.end());
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0F, 1.0F}) {
        const float within = half_[axis] - side * local[axis];
        if (within < farthest) hitPlane(-side * toLocal_.row(axis).transpose(), within, directions, hits);
      }
    }
    return;
  }
  // A ray has to come through the gap between the origin and the nearest face's plane first.
  int axis = 0;
  const float gap = (local.cwiseAbs() - half_).maxCoeff(&axis);
  const Vec3f towards = std::copysign(1.0F, -local[axis]) * toLocal_.row(axis).transpose();
  constexpr float kSurely = 0.9999F;
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const float along =
        towards.x() * directions.x[k] + towards.y() * directions.y[k] + towards.z() * directions.z[k];
    if (hits[k] * along < kSurely * gap) continue;
    const auto [enter, leave] = crossing(local, directions, k);
    if (enter < leave && leave > 0) hits[k] = std::min(hits[k], std::max(enter, 0.0F));
  }
}

void Box::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  const Vec3f local = toLocal(origin);
  for (std::size_t k = 0; k < exits.size(); ++k) exits[k] = crossing(local, directions, k).leave;
}

float Box::thickness() const {
  return fluid_ == Fluid::outside ? 2 * half_.minCoeff() : Surface::thickness();
}

bool Box::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  if (fluid_ == Fluid::inside) return false;
  const Vec3f start = toLocal(from), way = toLocal(to) - start;
  float enter = -std::numeric_limits<float>::infinity(), leave = std::numeric_limits<float>::infinity();
  int face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (std::abs(start[axis]) >= half_[axis]) return false;
      continue;
    }
    const float in = (std::copysign(half_[axis], -way[axis]) - start[axis]) / way[axis];
    if (in > enter) {
      enter = in;
      face = axis;
    }
    leave = std::min(leave, (std::copysign(half_[axis], way[axis]) - start[axis]) / way[axis]);
  }
  entry = std::max(enter, 0.0F);
  if (entry >= std::min(leave, 1.0F)) return false;
  normal = std::copysign(1.0F, -way[face]) * toLocal_.row(face).transpose();
  return true;
}

Box::Crossing Box::crossing(const Vec3f& local, const Directions& directions, std::size_t k) const {
  // Slabs: the ray is in the block between the last entry into a pair of faces and the first exit from one.
  const Vec3f w = toLocal_ * Vec3f(directions.x[k], directions.y[k], directions.z[k]);
  Crossing crossing{-std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    const float along = w[axis];
    if (std::abs(along) < 1e-9F) {  // along the faces: between them, or not
      if (std::abs(local[axis]) >= half_[axis]) return {1, 0};
      continue;
    }
    crossing.enter = std::max(crossing.enter, (std::copysign(half_[axis], -along) - local[axis]) / along);
    crossing.leave = std::min(crossing.leave, (std::copysign(half_[axis], along) - local[axis]) / along);
  }
  return crossing;
}

Vec3d Box::corner(int index) const {
  const Vec3d signs((index & 1) != 0 ? 1 : -1, (index & 2) != 0 ? 1 : -1, (index & 4) != 0 ? 1 : -1);
  return geometry_.center + geometry_.axes * geometry_.halfExtents.cwiseProduct(signs);
}

bool Box::enclosed(TriangleMesh& mesh) const {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int index = 0; index < 8; ++index) mesh.vertices.emplace_back(corner(index).cast<float>());
  constexpr std::array<std::array<std::uint32_t, 3>, 12> kFaces{{{0, 2, 1},
                                                                 {1, 2, 3},
                                                                 {4, 5, 6},
                                                                 {5, 7, 6},
                                                                 {0, 1, 4},
                                                                 {1, 5, 4},
                                                                 {2, 6, 3},
                                                                 {3, 6, 7},
                                                                 {0, 4, 2},
                                                                 {2, 4, 6},
                                                                 {1, 3, 5},
                                                                 {3, 7, 5}}};
  for (const auto& [a, b, c] : kFaces) mesh.triangles.push_back({first + a, first + b, first + c});
  return true;
}

std::optional<ClosedForm> Box::closedForm() const {
  return ClosedForm{ClosedForm::Kind::box, geometry_.center, geometry_.axes, geometry_.halfExtents,
                    fluid_ == Fluid::inside};
}

Bounds Box::bounds() const {
  Bounds bounds;
  for (int index = 0; index < 8; ++index) bounds.include(corner(index));
  return bounds;
}

void Box::wireframe(const Bounds&, std::vector<LineSegment>& out) const {
  for (int index = 0; index < 8; ++index)
    for (const int bit : {1, 2, 4})
      if ((index & bit) == 0) out.push_back({corner(index).cast<float>(), corner(index | bit).cast<float>()});
}

}  // namespace migiwa
