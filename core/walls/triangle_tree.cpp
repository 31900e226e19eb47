#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/walls/triangles.h"

namespace migiwa {

namespace {

constexpr std::uint32_t kLeaf = 4;
/// Of the largest coordinate: places nearer than that to each other are one.
constexpr float kRounding = 4e-6F;

/// Where the nearest point of a triangle lies.
enum class Part { face, border };

struct Foot {
  Vec3f place;
  Part part;
};

/// The nearest point of a triangle, by the regions about its corners and edges (Ericson 2005, 5.1.5).
Foot footOn(const std::array<Vec3f, 3>& t, const Vec3f& p) {
  const Vec3f ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const float d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {t[0], Part::border};
  const Vec3f bp = p - t[1];
  const float d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {t[1], Part::border};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {t[0] + d1 / (d1 - d3) * ab, Part::border};
  const Vec3f cp = p - t[2];
  const float d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {t[2], Part::border};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {t[0] + d2 / (d2 - d6) * ac, Part::border};
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {t[1] + (d4 - d3) / (d4 - d3 + d5 - d6) * (t[2] - t[1]), Part::border};
  const float sum = va + vb + vc;
  return {t[0] + vb / sum * ab + vc / sum * ac, Part::face};
}

/// The angle that the triangle spans about a point of its border, over pi: the share of a small disc about
/// it, doubled.
float angleAt(const WallTriangle& triangle, const Vec3f& place, float rounding) {
  for (std::size_t k = 0; k < 3; ++k) {
    if ((triangle.corners[k] - place).squaredNorm() > rounding * rounding) continue;
    const Vec3f one = triangle.corners[(k + 1) % 3] - triangle.corners[k],
                other = triangle.corners[(k + 2) % 3] - triangle.corners[k];
    const float lengths = one.norm() * other.norm();
    if (lengths <= 0) return 0;
    const auto cosine = static_cast<double>(std::clamp(one.dot(other) / lengths, -1.0F, 1.0F));
    return static_cast<float>(0.5 - portable::asin(cosine) / std::numbers::pi);
  }
  return 1;
}

}  // namespace

TriangleTree::TriangleTree(std::vector<WallTriangle> triangles) : triangles_(std::move(triangles)) {
  for (const WallTriangle& triangle : triangles_)
    for (const Vec3f& corner : triangle.corners) bounds_.include(corner.cast<double>());
  if (triangles_.empty()) return;
  rounding_ = kRounding * static_cast<float>(
                              std::max(bounds_.min.cwiseAbs().maxCoeff(), bounds_.max.cwiseAbs().maxCoeff()));
  branches_.reserve(triangles_.size());
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto at = static_cast<std::uint32_t>(branches_.size());
  Branch branch{Vec3f::Constant(std::numeric_limits<float>::infinity()),
                Vec3f::Constant(-std::numeric_limits<float>::infinity()), begin, end, 0};
  for (std::uint32_t k = begin; k < end; ++k) {
    for (const Vec3f& corner : triangles_[k].corners) {
      branch.low = branch.low.cwiseMin(corner);
      branch.high = branch.high.cwiseMax(corner);
    }
  }
  branches_.push_back(branch);
  if (end - begin <= kLeaf) return at;
  int axis = 0;
  (branch.high - branch.low).maxCoeff(&axis);
  const auto middle = [axis](const WallTriangle& t) {
    return t.corners[0][axis] + t.corners[1][axis] + t.corners[2][axis];
  };
  const std::uint32_t half = begin + (end - begin) / 2;
  // Sorted, not parted: the order of equals must not depend on the standard library.
  std::stable_sort(triangles_.begin() + begin, triangles_.begin() + end,
                   [&](const WallTriangle& a, const WallTriangle& b) { return middle(a) < middle(b); });
  build(begin, half);
  branches_[at].right = build(half, end);
  return at;
}

bool TriangleTree::meets(const Branch& branch, const Vec3f& from, const Vec3f& inverse) {
  float enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(inverse[axis])) {
      if (from[axis] < branch.low[axis] || from[axis] > branch.high[axis]) return false;
      continue;
    }
    const float a = (branch.low[axis] - from[axis]) * inverse[axis],
                b = (branch.high[axis] - from[axis]) * inverse[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  constexpr float kSlack = 1e-5F;
  return enter <= leave + kSlack;
}

Vec3f TriangleTree::meanNormal(const Vec3f& foot) const {
  Vec3f sum = Vec3f::Zero();
  visitWithin(foot, rounding_, [&](std::uint32_t k) {
    const WallTriangle& triangle = triangles_[k];
    if ((footOn(triangle.corners, foot).place - foot).squaredNorm() > rounding_ * rounding_) return;
    sum += angleAt(triangle, foot, rounding_) * triangle.normal;
  });
  return sum;
}

float TriangleTree::sideAt(const WallTriangle& triangle, const Vec3f& foot, const Vec3f& way) const {
  float lowest = triangle.normal.dot(way), highest = lowest;
  visitWithin(foot, rounding_, [&](std::uint32_t k) {
    const WallTriangle& other = triangles_[k];
    if (other.sheet || (footOn(other.corners, foot).place - foot).squaredNorm() > rounding_ * rounding_)
      return;
    const float height = other.normal.dot(way);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  });
  if (lowest >= 0 || highest <= 0) return lowest + highest;
  for (const Vec3f& corner : triangle.corners)
    if ((corner - foot).squaredNorm() <= rounding_ * rounding_) return meanNormal(foot).dot(way);
  // At an edge, the face that the way leaves most steeply: where parts cross there are slivers beside it,
  // which the mean would count as faces.
  return -lowest > highest ? lowest : highest;
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3f& p) const {
  struct Waiting {
    float squared;
    std::uint32_t branch;
  };
  Waiting stack[64];
  int depth = 0;
  stack[depth++] = {squaredDistance(branches_[0], p), 0};
  float least = std::numeric_limits<float>::infinity();
  Foot foot{Vec3f::Zero(), Part::face};
  std::uint32_t index = 0;
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (next.squared >= least) continue;
    const Branch& branch = branches_[next.branch];
    if (branch.right != 0) {
      Waiting near{squaredDistance(branches_[next.branch + 1], p), next.branch + 1},
          far{squaredDistance(branches_[branch.right], p), branch.right};
      if (far.squared < near.squared) std::swap(near, far);
      if (far.squared < least) stack[depth++] = far;
      if (near.squared < least) stack[depth++] = near;
      continue;
    }
    for (std::uint32_t k = branch.begin; k < branch.end; ++k) {
      const Foot candidate = footOn(triangles_[k].corners, p);
      const float squared = (candidate.place - p).squaredNorm();
      if (!(squared < least)) continue;
      least = squared;
      foot = candidate;
      index = k;
    }
  }

  const WallTriangle& triangle = triangles_[index];
  const Vec3f way = p - foot.place;
  const float height = triangle.normal.dot(way);
  if (foot.part == Part::face) {
    if (triangle.sheet) return {std::abs(height), height < 0 ? Vec3f(-triangle.normal) : triangle.normal};
    return {height, triangle.normal};
  }
  const float distance = std::sqrt(least);
  // On the wall itself the way to it has no direction.
  if (distance <= rounding_) {
    const Vec3f mean = triangle.sheet ? triangle.normal : meanNormal(foot.place);
    const float length = mean.norm();
    return {triangle.sheet || mean.dot(way) >= 0 ? distance : -distance,
            length > 0 ? Vec3f(mean / length) : triangle.normal};
  }
  const bool behind = !triangle.sheet && sideAt(triangle, foot.place, way) < 0;
  const Vec3f direction = way / distance;
  if (!behind) return {distance, direction};
  return {-distance, -direction};
}

float TriangleTree::distanceTo(std::uint32_t index, const Vec3f& p) const {
  return (footOn(triangles_[index].corners, p).place - p).norm();
}

float meetingOf(const WallTriangle& triangle, const Vec3f& from, const Vec3f& to) {
  // In double: the sides of an edge must agree on what passes between them.
  const Vec3d a = triangle.corners[0].cast<double>() - from.cast<double>(),
              b = triangle.corners[1].cast<double>() - from.cast<double>(),
              c = triangle.corners[2].cast<double>() - from.cast<double>(), way = (to - from).cast<double>();
  const double u = way.dot(b.cross(c)), v = way.dot(c.cross(a)), w = way.dot(a.cross(b));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return -1;
  const double towards = u + v + w;
  if (towards == 0) return -1;
  const double along = (u * a + v * b + w * c).dot(way) / (towards * way.squaredNorm());
  return along >= 0 && along <= 1 ? static_cast<float>(along) : -1;
}

}  // namespace migiwa
