#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/base/hash.h"
#include "core/walls/mesh_wall.h"

namespace migiwa {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Of the support radius: so far behind a plane a point is still taken to lie in front of it.
constexpr float kOnPlane = 1e-3F;
/// Cosine between a face and the face behind it, beyond which they bound a wall and not a wedge.
constexpr float kOpposed = -0.7F;
/// Places along a triangle's edge at which its thickness is looked at: at most, for triangles that are large
/// against the support radius.
constexpr int kMostPlaces = 100;
/// Cosine between two faces whose edge is drawn smooth.
constexpr float kSmooth = 0.8F;

/// The corners of the box that goes so far (m) beyond a triangle.
std::pair<Vec3f, Vec3f> boxAround(const WallTriangle& triangle, float beyond) {
  const std::array<Vec3f, 3>& t = triangle.corners;
  return {t[0].cwiseMin(t[1]).cwiseMin(t[2]) - Vec3f::Constant(beyond),
          t[0].cwiseMax(t[1]).cwiseMax(t[2]) + Vec3f::Constant(beyond)};
}

/// Whether one can be the other side of the solid behind the other.
bool faceEachOther(const WallTriangle& one, const WallTriangle& other) {
  return !one.sheet && one.normal.dot(other.normal) <= kOpposed;
}

}  // namespace

TriangleWall::TriangleWall(std::shared_ptr<const TriangleTree> tree, bool vessel, float supportRadius)
    : tree_(std::move(tree)), vessel_(vessel), supportRadius_(supportRadius) {
  measureThickness();
}

void TriangleWall::measureThickness() {
  const std::vector<WallTriangle>& triangles = tree_->triangles();
  thin_.resize(triangles.size());
  alone_.resize(triangles.size(), true);
  aloneBehind_.resize(triangles.size(), true);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const float behind = triangles[k].sheet ? 0 : thicknessBehind(triangles[k]);
    thin_[k] = triangles[k].sheet || behind < supportRadius_;
    thickness_ = std::min(thickness_, behind);
    hasThick_ = hasThick_ || !thin_[k];
    if (!thin_[k] || supportRadius_ <= 0) continue;
    alone_[k] = standsAlone(static_cast<std::uint32_t>(k), false);
    if (triangles[k].sheet) aloneBehind_[k] = standsAlone(static_cast<std::uint32_t>(k), true);
  }
}

bool TriangleWall::standsAlone(std::uint32_t triangle, bool behind) const {
  // Another that it hides from a point lies behind its plane, and it before that of the other: some corners
  // of each do.
  const WallTriangle& own = tree_->triangles()[triangle];
  const float slack = kOnPlane * supportRadius_;
  const auto reaches = [slack](const WallTriangle& of, const WallTriangle& other, float side) {
    return std::any_of(other.corners.begin(), other.corners.end(), [&](const Vec3f& corner) {
      return side * of.normal.dot(corner - of.corners[0]) > slack;
    });
  };
  const auto mayHide = [&](const WallTriangle& other) {
    return reaches(own, other, behind ? 1 : -1) &&
           (reaches(other, own, 1) || (other.sheet && reaches(other, own, -1)));
  };
  // Of one support: all that a point sees of the wall together with this triangle.
  const auto [low, high] = boxAround(own, 2 * supportRadius_);
  return !tree_->visitBox(low, high,
                          [&](std::uint32_t k) { return k != triangle && mayHide(tree_->triangles()[k]); });
}

void TriangleWall::facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const {
  tree_->visitWithin(p, supportRadius, [&](std::uint32_t k) {
    const WallTriangle& triangle = tree_->triangles()[k];
    const std::array<Vec3f, 3>& corners = triangle.corners;
    const bool turned = triangle.sheet && triangle.normal.dot(p - corners[0]) < 0;
    out.push_back({{corners[0], corners[turned ? 2 : 1], corners[turned ? 1 : 2]},
                   3,
                   turned ? Vec3f(-triangle.normal) : triangle.normal,
                   thin_[k],
                   turned ? aloneBehind_[k] : alone_[k]});
  });
}

float TriangleWall::thicknessBehind(const WallTriangle& triangle) const {
  if (supportRadius_ <= 0) return kInfinity;
  // Where nothing near looks the other way, no ray has to.
  const auto [low, high] = boxAround(triangle, supportRadius_);
  if (!tree_->visitBox(low, high,
                       [&](std::uint32_t k) { return faceEachOther(tree_->triangles()[k], triangle); }))
    return kInfinity;
  const Vec3f one = triangle.corners[1] - triangle.corners[0],
              other = triangle.corners[2] - triangle.corners[0];
  const float longest = std::max({one.norm(), other.norm(), (one - other).norm()});
  const int places =
      1 + static_cast<int>(std::min(2 * longest / supportRadius_, static_cast<float>(kMostPlaces)));
  float least = kInfinity;
  for (int i = 0; i < places; ++i) {
    for (int j = 0; i + j < places; ++j) {
      const float u = (static_cast<float>(i) + 1.0F / 3) / static_cast<float>(places),
                  v = (static_cast<float>(j) + 1.0F / 3) / static_cast<float>(places);
      const Vec3f from =
          triangle.corners[0] + u * one + v * other - kOnPlane * supportRadius_ * triangle.normal;
      const Vec3f to = from - supportRadius_ * triangle.normal;
      tree_->visitWay(from, to, [&](std::uint32_t k) {
        const WallTriangle& behind = tree_->triangles()[k];
        if (!faceEachOther(behind, triangle)) return;
        const float at = meetingOf(behind, from, to);
        if (at >= 0) least = std::min(least, (at + kOnPlane) * supportRadius_);
      });
    }
  }
  return least;
}

void TriangleWall::describe(FieldWriter& visitor) const {
  // In halves that a number holds exactly.
  std::uint64_t sum = kEmptyChecksum;
  for (const WallTriangle& triangle : tree_->triangles())
    for (const Vec3f& corner : triangle.corners) sum = checksum(sum, corner.data(), 3 * sizeof(float));
  const double high = static_cast<double>(sum >> 32), low = static_cast<double>(sum & 0xFFFFFFFFU);
  visitor.number("corners_high", high, Range::closed(0, 0x1p32), {"1", ""});
  visitor.number("corners_low", low, Range::closed(0, 0x1p32), {"1", ""});
}

float TriangleWall::distance(const Vec3f& p, Vec3f& normal) const {
  const TriangleTree::Nearest nearest = tree_->nearest(p);
  normal = nearest.normal;
  return nearest.distance;
}

bool TriangleWall::project(Vec3f& p, float margin) const {
  return projectAlongNormals(*this, p, margin);
}

void TriangleWall::firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const {
  thread_local std::vector<SeenTriangle> seen;
  seen.clear();
  const float slack = kOnPlane * supportRadius_;
  tree_->visitWithin(origin, *std::max_element(hits.begin(), hits.end()), [&](std::uint32_t k) {
    const WallTriangle& triangle = tree_->triangles()[k];
    const float height = triangle.normal.dot(origin - triangle.corners[0]);
    if (triangle.sheet || height >= -slack)
      seen.push_back(seenFrom(origin, triangle, height < 0 && triangle.sheet));
  });
  hitTriangles(seen, directions, hits);
}

void TriangleWall::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  thread_local std::vector<std::uint32_t> inReach;
  thread_local std::vector<SeenTriangle> thin, thick, behind;
  thread_local std::vector<float> thinHits, thickHits;
  const float slack = kOnPlane * supportRadius_;
  const float reach =
      supportRadius_ > 0 ? supportRadius_ : static_cast<float>(tree_->bounds().size().norm()) + 1;
  const auto heightOver = [&](std::uint32_t k) {
    const WallTriangle& triangle = tree_->triangles()[k];
    return triangle.normal.dot(origin - triangle.corners[0]);
  };
  inReach.clear();
  bool passable = false;
  tree_->visitWithin(origin, reach, [&](std::uint32_t k) {
    inReach.push_back(k);
    passable = passable || (!thin_[k] && heightOver(k) >= -slack);
  });
  std::fill(exits.begin(), exits.end(), kInfinity);
  if (!passable) return;
  thin.clear(), thick.clear(), behind.clear();
  for (const std::uint32_t k : inReach) {
    const WallTriangle& triangle = tree_->triangles()[k];
    const float height = heightOver(k);
    if (!triangle.sheet && height < -slack) {
      behind.push_back(seenFrom(origin, triangle, true));
    } else {
      (thin_[k] ? thin : thick).push_back(seenFrom(origin, triangle, triangle.sheet && height < 0));
    }
  }
  thinHits.assign(exits.size(), kInfinity);
  thickHits.assign(exits.size(), kInfinity);
  hitTriangles(thin, directions, thinHits);
  hitTriangles(thick, directions, thickHits);
  hitTriangles(behind, directions, exits);
  for (std::size_t k = 0; k < exits.size(); ++k)
    if (thinHits[k] <= thickHits[k]) exits[k] = kInfinity;
}

bool TriangleWall::thinWithin(const Vec3f& p, float reach, float /*supportRadius*/) const {
  return tree_->visitWithin(p, reach,
                            [&](std::uint32_t k) { return thin_[k] && tree_->distanceTo(k, p) < reach; });
}

bool TriangleWall::hides(const Vec3f& from, const Vec3f& to) const {
  return tree_->visitWay(
      from, to, [&](std::uint32_t k) { return thin_[k] && meetingOf(tree_->triangles()[k], from, to) >= 0; });
}

bool TriangleWall::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  float first = kInfinity;
  const Vec3f way = to - from;
  tree_->visitWay(from, to, [&](std::uint32_t k) {
    const WallTriangle& triangle = tree_->triangles()[k];
    const float towards = triangle.normal.dot(way);
    if (towards > 0 && !triangle.sheet) return;
    const float at = meetingOf(triangle, from, to);
    if (at < 0 || at >= first) return;
    first = at;
    normal = towards > 0 ? Vec3f(-triangle.normal) : triangle.normal;
  });
  if (first > 1) return false;
  entry = first;
  return true;
}

WallMesh TriangleWall::mesh() const {
  // Corners at one place whose faces bend little share a normal.
  using Place = std::tuple<float, float, float>;
  const auto placeOf = [](const Vec3f& p) { return Place(p.x(), p.y(), p.z()); };
  std::map<Place, std::vector<std::pair<Vec3f, float>>> around;
  const auto areaOf = [](const WallTriangle& t) {
    return (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).norm();
  };
  for (const WallTriangle& triangle : tree_->triangles())
    for (const Vec3f& corner : triangle.corners)
      around[placeOf(corner)].emplace_back(triangle.normal, areaOf(triangle));
  WallMesh drawn;
  drawn.vessel = vessel_;
  for (const WallTriangle& triangle : tree_->triangles()) {
    std::array<std::uint32_t, 3> numbers{};
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3f normal = Vec3f::Zero();
      for (const auto& [other, area] : around[placeOf(triangle.corners[k])])
        if (other.dot(triangle.normal) > kSmooth) normal += area * other;
      numbers[k] = static_cast<std::uint32_t>(drawn.surface.vertices.size());
      drawn.surface.vertices.push_back(triangle.corners[k]);
      drawn.normals.emplace_back(normal.isZero() ? triangle.normal : Vec3f(normal.normalized()));
    }
    drawn.surface.triangles.push_back(numbers);
  }
  return drawn;
}

bool TriangleWall::enclosed(TriangleMesh& mesh) const {
  const std::vector<WallTriangle>& triangles = tree_->triangles();
  if (std::any_of(triangles.begin(), triangles.end(), [](const WallTriangle& t) { return t.sheet; }))
    return false;
  for (const WallTriangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), triangle.corners.begin(), triangle.corners.end());
    mesh.triangles.push_back({first, first + (vessel_ ? 2U : 1U), first + (vessel_ ? 1U : 2U)});
  }
  return true;
}

}  // namespace migiwa
