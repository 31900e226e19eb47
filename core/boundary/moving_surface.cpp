#include "core/boundary/moving_surface.h"

namespace migiwa {

namespace {

std::array<Vec3d, 8> corners(const Bounds& bounds) {
  std::array<Vec3d, 8> result;
  for (std::size_t k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis)
      result[k][axis] = (k >> axis & 1) != 0 ? bounds.max[axis] : bounds.min[axis];
  return result;
}

/// Directions in the wall's rest frame. Each thread has its own: shapes know directions by their place in
/// memory within one evaluation.
const Directions& turned(const Directions& directions, const Eigen::Matrix3f& turn) {
  thread_local Directions result;
  const std::size_t n = directions.size();
  result.x.resize(n), result.y.resize(n), result.z.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3f w = turn * Vec3f(directions.x[k], directions.y[k], directions.z[k]);
    result.x[k] = w.x(), result.y[k] = w.y(), result.z[k] = w.z();
  }
  return result;
}

}  // namespace

MovingSurface::MovingSurface(std::shared_ptr<const Surface> rest, int group)
    : rest_(std::move(rest)), group_(group) {
  moveTo(0, 0);
}

void MovingSurface::moveTo(double before, double now) {
  const Pose old = motion().at(before);
  now_ = motion().at(now);
  turned_ = !(now_.linear() - Eigen::Matrix3d::Identity()).isZero(1e-12);
  toRest_ = now_.linear().transpose().cast<float>();
  shift_ = now_.translation().cast<float>();

  const Pose carry = now_ * old.inverse();
  moved_ = !(carry.matrix() - Eigen::Matrix4d::Identity()).isZero(1e-12);
  carryTurn_ = carry.linear().cast<float>();
  carryShift_ = carry.translation().cast<float>();
  spin_.setZero();
  drift_.setZero();
  if (!moved_) return;
  // Where a point of the wall is now, less where it was: in double, for steps are short.
  const Pose back = carry.inverse();
  spin_ = ((Eigen::Matrix3d::Identity() - back.linear()) / (now - before)).cast<float>();
  drift_ = (-back.translation() / (now - before)).cast<float>();
}

float MovingSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const float result = rest_->distance(toRest(p), normal);
  normal = directionToWorld(normal);
  return result;
}

bool MovingSurface::project(Vec3f& p, float margin) const {
  Vec3f local = toRest(p);
  if (!rest_->project(local, margin)) return false;
  p = toWorld(local);
  return true;
}

void MovingSurface::otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const {
  const std::size_t before = out.size();
  rest_->otherWaysOut(toRest(p), margin, out);
  for (std::size_t k = before; k < out.size(); ++k) out[k] = toWorld(out[k]);
}

void MovingSurface::firstHits(const Vec3f& origin, const Directions& directions,
                              std::span<float> hits) const {
  rest_->firstHits(toRest(origin), turned_ ? turned(directions, toRest_) : directions, hits);
}

void MovingSurface::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  rest_->exits(toRest(origin), turned_ ? turned(directions, toRest_) : directions, exits);
}

bool MovingSurface::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  if (!rest_->crosses(toRest(from), toRest(to), normal, entry)) return false;
  normal = directionToWorld(normal);
  return true;
}

void MovingSurface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  const std::size_t before = out.size();
  rest_->pieces(toRest(p), reach, out);
  for (std::size_t k = before; k < out.size(); ++k) {
    out[k].normal = directionToWorld(out[k].normal);
    out[k].foot = toWorld(out[k].foot);
  }
}

Bounds MovingSurface::bounds() const {
  return migiwa::moved(rest_->bounds(), now_);
}

void MovingSurface::wireframe(const Bounds& scene, std::vector<LineSegment>& out) const {
  const std::size_t before = out.size();
  rest_->wireframe(migiwa::moved(scene, now_.inverse()), out);
  for (std::size_t k = before; k < out.size(); ++k) out[k] = {toWorld(out[k].from), toWorld(out[k].to)};
}

WallMesh MovingSurface::mesh() const {
  WallMesh mesh = rest_->mesh();
  for (Vec3f& vertex : mesh.surface.vertices) vertex = toWorld(vertex);
  for (Vec3f& normal : mesh.normals) normal = directionToWorld(normal);
  return mesh;
}

void MovingSurface::drawnNodes(std::vector<WallNode>& out) const {
  const std::size_t before = out.size();
  rest_->drawnNodes(out);
  for (std::size_t k = before; k < out.size(); ++k) {
    out[k].centre = toWorld(out[k].centre);
    out[k].normal = directionToWorld(out[k].normal);
  }
}

Bounds moved(const Bounds& bounds, const Pose& pose) {
  Bounds result;
  if (bounds.empty()) return result;
  for (const Vec3d& corner : corners(bounds)) result.include(pose * corner);
  return result;
}

Bounds sweptBounds(const Surface& surface, double duration) {
  if (!surface.motion) return surface.bounds();
  constexpr int kPlaces = 256;
  Bounds result;
  for (int k = 0; k <= kPlaces; ++k)
    result.include(moved(surface.bounds(), surface.motion->at(duration * k / kPlaces)));
  return result;
}

double largestSpeed(const Motion& motion, const Bounds& bounds, double from, double to) {
  constexpr int kParts = 8;
  const double part = (to - from) / kParts;
  if (bounds.empty() || part <= 0) return 0;
  double farthest = 0;
  Pose before = motion.at(from);
  for (int k = 1; k <= kParts; ++k) {
    const Pose after = motion.at(from + k * part);
    for (const Vec3d& corner : corners(bounds))
      farthest = std::max(farthest, (after * corner - before * corner).norm());
    before = after;
  }
  return farthest / part;
}

}  // namespace migiwa
