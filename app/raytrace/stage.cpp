#include "app/raytrace/stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace migiwa {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
/// The ground fades into the horizon between these distances from the scene, in its extents.
constexpr float kHazeFrom = 1.2F, kHazeTo = 7;

Vec3f linearColor(float r, float g, float b) {
  return {r, g, b};
}

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

}  // namespace

Stage::Stage(const StageContent& content)
    : surfaces_(content.walls->surfaces()), surround_(content.surround) {
  const Scene& scene = *content.scene;
  spacing_ = static_cast<float>(scene.particleSpacing);
  mattColor_ = scene.view.look.mattColor.cast<float>();
  waterLoss_ = lossOf(scene.view.look.waterColor, scene.view.look.waterDepth);
  setSurroundings(content);
  addBodies(content);
  addWater(content);
}

void Stage::setSurroundings(const StageContent& content) {
  const Scene& scene = *content.scene;
  const std::vector<WallMaterial>& materials = scene.view.look.walls;
  Bounds bounds, shown;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const Bounds own = surfaces_[k]->bounds();
    if (own.empty()) continue;
    bounds.include(own);
    if (k >= materials.size() || materials[k] != WallMaterial::hidden) shown.include(own);
  }
  for (const Vec3f& p : content.water->positions) bounds.include(p.cast<double>());
  if (bounds.empty()) bounds.include(scene.view.camera.target);
  extent_ = static_cast<float>(std::max(bounds.size().maxCoeff(), 10 * scene.particleSpacing));
  offset_ = 2e-6F * extent_;
  // Green at its edges, as plate glass is, whatever the size of the scene.
  glassLoss_ = linearColor(0.7F, 0.14F, 0.32F) / extent_;

  Eigen::Index axis = 0;
  scene.view.camera.up.cwiseAbs().maxCoeff(&axis);
  const double sign = scene.view.camera.up[axis] < 0 ? -1 : 1;
  up_ = Vec3f::Unit(axis) * static_cast<float>(sign);
  groundPoint_ = bounds.center().cast<float>();
  const Bounds& standing = shown.empty() ? bounds : shown;
  groundPoint_[axis] = static_cast<float>(sign < 0 ? standing.max[axis] : standing.min[axis]);

  if (surround_ == Surround::furnace) {
    glassLoss_.setZero();
    return;
  }
  // A wide light above, behind the scene and to the left, which shows the edges of water.
  const Vec3f center = bounds.center().cast<float>();
  Vec3f ahead = scene.view.camera.target.cast<float>() - scene.view.camera.eye.cast<float>();
  ahead -= ahead.dot(up_) * up_;
  ahead = ahead.norm() > 1e-6F * extent_ ? Vec3f(ahead.normalized()) : up_.unitOrthogonal();
  const Eigen::Matrix3d turn =
      rotationAbout(up_.cast<double>(), scene.view.look.lightTurn * std::numbers::pi / 180);
  ahead = (turn * ahead.cast<double>()).cast<float>();
  const Vec3f right = ahead.cross(up_);
  light_.center = center + extent_ * (5.2F * up_ - 3.8F * right + 2.2F * ahead);
  light_.normal = (center - light_.center).normalized();
  light_.u = light_.normal.cross(up_).normalized() * (1.9F * extent_);
  light_.v = light_.normal.cross(light_.u);
  light_.area = 4 * light_.u.norm() * light_.v.norm();
  light_.radiance = 13.0F * linearColor(1.0F, 0.95F, 0.88F);
}

void Stage::addBodies(const StageContent& content) {
  const std::vector<WallMaterial>& wanted = content.scene->view.look.walls;
  const float thickness = glassThickness();
  bool shells = false;
  for (std::size_t k = 0; k < surfaces_.size(); ++k) {
    const Surface& surface = *surfaces_[k];
    const WallMaterial material = k < wanted.size() ? wanted[k] : WallMaterial::automatic;
    const std::optional<ClosedForm> form = surface.closedForm();
    const bool vessel = form ? form->fluidInside : surface.mesh().vessel;
    const bool glass = material == WallMaterial::glass || (material == WallMaterial::automatic && vessel);
    std::optional<Body> body;
    if (material != WallMaterial::hidden) body = Body::around(surface, glass, thickness, up_);
    if (!body) {
      hidden_.push_back(&surface);
      continue;
    }
    shells = shells || (glass && vessel);
    bodies_.push_back(std::move(*body));
    shown_.push_back(&surface);
  }
  hasGround_ = content.ground;
  // A shell of glass stands on the ground with a little air between them.
  if (shells) groundPoint_ -= (thickness + 2e-4F * extent_) * up_;
  if (hasGround_) bodies_.push_back(Body::ground(groundPoint_, up_));
}

Vec3f Stage::sky(const Vec3f& direction) const {
  if (surround_ == Surround::furnace) return Vec3f::Ones();
  const float height = direction.dot(up_);
  const Vec3f horizon = linearColor(0.60F, 0.64F, 0.70F), zenith = linearColor(0.07F, 0.17F, 0.40F),
              below = linearColor(0.55F, 0.56F, 0.57F);
  if (height < 0) return horizon + smoothStep(0, -0.3F, height) * (below - horizon);
  return horizon + (1 - std::pow(1 - height, 2.5F)) * (zenith - horizon);
}

Vec3f Stage::transmittance(Medium medium, float distance) const {
  if (medium == Medium::air) return Vec3f::Ones();
  const Vec3f& loss = medium == Medium::water ? waterLoss_ : glassLoss_;
  return (-distance * loss).array().exp().matrix();
}

Place Stage::placeOf(const Vec3f& p) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (bodies_[k].glass() && bodies_[k].contains(p)) return {Medium::glass, static_cast<int>(k)};
  return {};
}

/// What is before a wall: what is around the wall's point, if the wall is thought away. The water is closed
/// behind its walls, so its winding number tells, counted on the way into the wall.
Medium Stage::fluidAt(const Vec3f& p, const BodyHit& hit) const {
  if (hit.outside) return Medium::air;
  int winding = 0;
  TriangleRays::Hit face;
  for (float from = 0; water_.first(p, -hit.normal, from, kNone, face);
       from = std::nextafter(face.distance, kNone))
    winding += hit.normal.dot(face.normal) < 0 ? 1 : -1;
  return winding > 0 ? Medium::water : Medium::air;
}

void Stage::meetWater(const Vec3f& origin, const Vec3f& direction, Medium medium, Event& event) const {
  int overlapping = 0;
  TriangleRays::Hit hit;
  for (float from = 0; water_.first(origin, direction, from, event.distance, hit);
       from = std::nextafter(hit.distance, kNone)) {
    const bool front = direction.dot(hit.normal) < 0;
    const Medium before = front ? Medium::air : Medium::water;
    // Where triangles of the water pass through each other, at ragged contact lines, a face comes once too
    // often on the way, and so does its counterpart.
    if (before != medium) {
      // But the face that the ray starts from shows its other side.
      if (hit.distance >= 4 * offset_) ++overlapping;
      continue;
    }
    if (overlapping > 0) {
      --overlapping;
      continue;
    }
    const auto& [a, b, c] = triangles_[hit.triangle];
    const Vec3f smooth = (1 - hit.u - hit.v) * normals_[a] + hit.u * normals_[b] + hit.v * normals_[c];
    const float side = front ? 1.0F : -1.0F;
    event.kind = Event::Kind::interface;
    event.distance = hit.distance;
    event.normal = side * hit.normal;
    event.shading = side * smooth.normalized();
    event.before = before;
    event.beyond = {front ? Medium::water : Medium::air};
    event.meshed = true;
    event.byLabel = false;
    return;
  }
}

Event Stage::matt(const Event& event, int body) const {
  Event result = event;
  result.kind = Event::Kind::matt;
  result.albedo = mattColor_;
  if (!hasGround_ || body + 1 != static_cast<int>(bodies_.size())) return result;
  if (surround_ == Surround::studio) {
    result.albedo = linearColor(0.52F, 0.52F, 0.53F);
    result.haze = smoothStep(kHazeFrom * extent_, kHazeTo * extent_, (event.point - groundPoint_).norm());
  }
  return result;
}

void Stage::meetBodies(const Vec3f& origin, const Vec3f& direction, Medium medium, Event& event) const {
  // A wall within rounding behind the water is where both end.
  const float water = event.distance;
  BodyHit hit;
  hit.distance = water + offset_;
  int met = -1;
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (bodies_[k].enter(origin, direction, hit)) met = static_cast<int>(k);
  if (met < 0) return;
  const Body& body = bodies_[static_cast<std::size_t>(met)];
  event.distance = hit.distance;
  event.point = origin + hit.distance * direction;
  event.normal = hit.normal;
  event.shading = hit.shading;
  event.before = hit.distance > water - offset_ ? medium : fluidAt(event.point, hit);
  event.meshed = body.meshed();
  event.byLabel = false;
  if (body.glass()) {
    event.kind = Event::Kind::interface;
    event.beyond = {Medium::glass, met};
  } else {
    event = matt(event, met);
  }
}

void Stage::meetLight(const Vec3f& origin, const Vec3f& direction, Event& event) const {
  if (light_.area <= 0) return;
  const float towards = -direction.dot(light_.normal);
  if (towards <= 0) return;
  const float at = (origin - light_.center).dot(light_.normal) / towards;
  if (at <= 0 || at >= event.distance) return;
  const Vec3f across = origin + at * direction - light_.center;
  if (std::abs(across.dot(light_.u)) > light_.u.squaredNorm() ||
      std::abs(across.dot(light_.v)) > light_.v.squaredNorm())
    return;
  event.kind = Event::Kind::light;
  event.distance = at;
  event.before = Medium::air;
}

Event Stage::inGlass(const Vec3f& origin, const Vec3f& direction, Place place) const {
  Event event;
  event.before = Medium::glass;
  float gone = 0;
  // Bodies of glass that touch are one.
  for (int touching = 0; touching < 8; ++touching) {
    BodyHit hit;
    const Body& body = bodies_[static_cast<std::size_t>(place.body)];
    if (!body.leave(origin + gone * direction, direction, hit)) {
      event.distance = kNone;
      return event;
    }
    gone += hit.distance;
    event.distance = gone;
    event.point = origin + gone * direction;
    event.normal = -hit.normal;
    event.shading = -hit.shading;
    event.meshed = body.meshed();
    const Vec3f beyond = event.point + 1e-3F * spacing_ * hit.normal;
    int other = -1;
    for (std::size_t k = 0; k < bodies_.size(); ++k)
      if (static_cast<int>(k) != place.body && bodies_[k].contains(beyond)) other = static_cast<int>(k);
    if (other < 0) {
      event.kind = Event::Kind::interface;
      event.beyond = {fluidAt(event.point, hit)};
      event.byLabel = true;
      return event;
    }
    if (!bodies_[static_cast<std::size_t>(other)].glass()) return matt(event, other);
    place.body = other;
  }
  return event;
}

Event Stage::next(const Vec3f& origin, const Vec3f& direction, const Place& place) const {
  if (place.medium == Medium::glass) return inGlass(origin, direction, place);
  Event event;
  event.distance = kNone;
  meetWater(origin, direction, place.medium, event);
  event.point = origin + std::min(event.distance, 1e6F * extent_) * direction;
  meetBodies(origin, direction, place.medium, event);
  meetLight(origin, direction, event);
  return event;
}

bool Stage::blocked(const Vec3f& origin, const Vec3f& direction, float distance) const {
  for (const Body& body : bodies_)
    if (body.blocks(origin, direction, distance)) return true;
  return water_.any(origin, direction, 0, distance);
}

}  // namespace migiwa
