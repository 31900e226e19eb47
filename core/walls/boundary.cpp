#include "core/walls/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/fields.h"
#include "core/base/math.h"
#include "core/base/registry.h"
#include "core/walls/mesh_wall.h"
#include "core/walls/shapes.h"
#include "core/walls/slim_wall.h"
#include "core/walls/surface.h"

namespace migiwa {

Boundary::Boundary(std::vector<std::shared_ptr<const Surface>> surfaces) : surfaces_(std::move(surfaces)) {
  for (auto& surface : surfaces_) {
    if (!surface->motion) continue;
    const auto same = std::find_if(moving_.begin(), moving_.end(), [&](const auto& known) {
      return known->motion().sameAs(*surface->motion);
    });
    const int group = same != moving_.end() ? (*same)->group() : static_cast<int>(moving_.size());
    moving_.push_back(std::make_shared<MovingSurface>(surface, group));
    surface = moving_.back();
  }
  measureSteadiness();
  near_ = WallIndex(pointers());
}

std::vector<const Surface*> Boundary::pointers() const {
  std::vector<const Surface*> walls;
  for (const auto& surface : surfaces_) walls.push_back(surface.get());
  return walls;
}

void Boundary::measureSteadiness() {
  steady_ = std::all_of(surfaces_.begin(), surfaces_.end(),
                        [](const auto& surface) { return surface->steadyDistance(); });
  const bool exact = std::all_of(surfaces_.begin(), surfaces_.end(),
                                 [](const auto& surface) { return surface->exact() == nullptr; });
  steepness_ = exact ? kExactSlope : kSteepestDistance;
}

Boundary Boundary::atRest(std::vector<std::shared_ptr<const Surface>> surfaces) {
  Boundary boundary;
  boundary.surfaces_ = std::move(surfaces);
  boundary.measureSteadiness();
  boundary.near_ = WallIndex(boundary.pointers());
  return boundary;
}

void Boundary::moveTo(double before, double now) {
  for (const auto& surface : moving_) surface->moveTo(before, now);
}

Vec3f Boundary::nearestVelocity(const Vec3f& p) const {
  const Surface* nearest = nullptr;
  float least = std::numeric_limits<float>::infinity();
  for (const auto& surface : surfaces_) {
    Vec3f normal;
    const float d = surface->distance(p, normal);
    if (d >= least) continue;
    least = d;
    nearest = surface.get();
  }
  return nearest != nullptr ? nearest->velocity(p) : Vec3f(Vec3f::Zero());
}

float Boundary::distance(const Vec3f& p, Vec3f& normal) const {
  float nearest = std::numeric_limits<float>::infinity();
  normal.setZero();
  for (const auto& [surface, block, vessel] : near(p)) {
    if (block != nullptr && block->farther(p, nearest)) continue;
    Vec3f n;
    const float d = surface->distance(p, n);
    if (d < nearest) {
      nearest = d;
      normal = n;
    }
  }
  return nearest;
}

// All that these two call is put in its place: particles at walls ask them several times a step.

[[gnu::flatten]] float Boundary::distance(const Vec3f& p) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float nearest = kInfinity, squared = kInfinity;  // squared: of blocks that p is outside of
  for (const auto& [surface, block, vessel] : near(p)) {
    if (block != nullptr) {
      const float own = block->squaredDistance(p);
      squared = std::min(squared, own > 0 ? own : squared);
      if (own > 0) continue;
    }
    Vec3f ignored;
    nearest = std::min(nearest, vessel != nullptr ? vessel->distance(p) : surface->distance(p, ignored));
  }
  return std::min(nearest, std::sqrt(squared));
}

[[gnu::flatten]] bool Boundary::projectInTurn(Vec3f& p, float margin, bool& fits) const {
  // Each surface in turn until none moves the point. Where surfaces leave no room the point swings between
  // them, and the mean of the last swing lies midway.
  constexpr int kRounds = 16;
  const Vec3f start = p;
  const float rounding = 1e-4F * margin;
  Vec3f middle = p;
  for (int round = 0; round < kRounds; ++round) {
    Vec3f sum = Vec3f::Zero();
    int moves = 0;
    float farthest = 0;
    for (const IndexedWall& wall : near(p, margin)) {
      if (wall.block != nullptr && wall.block->farther(p, margin)) continue;
      const Vec3f before = p;
      if (!wall.project(p, margin)) continue;
      farthest = std::max(farthest, (p - before).norm());
      sum += p;
      ++moves;
    }
    if (farthest <= rounding) {
      fits = true;
      return p != start;
    }
    middle = sum / static_cast<float>(moves);
  }
  fits = false;
  p = middle;
  return true;
}

bool Boundary::project(Vec3f& p, float margin) const {
  if (surfaces_.empty()) return false;
  if (surfaces_.size() == 1) return surfaces_.front()->project(p, margin);
  const Vec3f start = p;
  bool fits = true;
  const bool moved = projectInTurn(p, margin, fits);
  if (fits) return moved;

  // The shortest way out of one wall leads into another: take the shortest of the other ways that end in the
  // fluid.
  std::vector<Vec3f> ways;
  for (const Surface* surface : near(start, margin)) surface->otherWaysOut(start, margin, ways);
  float best = std::numeric_limits<float>::infinity();
  for (Vec3f& way : ways) {
    projectInTurn(way, margin, fits);
    const float length = (way - start).norm();
    if (!fits || length >= best) continue;
    best = length;
    p = way;
  }
  return true;
}

namespace {

template <class Shape>
std::unique_ptr<Surface> make() {
  return std::make_unique<Shape>();
}

Registry<Surface>& shapes() {
  static Registry<Surface> all("a shape", {
                                              {"plane", make<Plane>},
                                              {"box", make<Box>},
                                              {"sphere", make<Sphere>},
                                              {"polynomial", make<Polynomial>},
                                              {"slim", make<SlimSurface>},
                                              {"mesh", make<MeshSurface>},
                                              {"group", make<GroupSurface>},
                                          });
  return all;
}

}  // namespace

std::span<const std::string_view> surfaceShapes() {
  return shapes().names();
}

std::unique_ptr<Surface> makeSurface(int shape) {
  return shapes().make(shape);
}

void registerSurface(const std::string& name, std::function<std::unique_ptr<Surface>()> make) {
  shapes().add(name, std::move(make));
}

Directions fibonacciDirections(int count) {
  Directions set;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2.0 * k + 1) / count;
    const double radius = std::sqrt(1 - z * z);
    set.x.push_back(static_cast<float>(radius * portable::cos(golden * k)));
    set.y.push_back(static_cast<float>(radius * portable::sin(golden * k)));
    set.z.push_back(static_cast<float>(z));
  }
  return set;
}

std::vector<std::shared_ptr<const Surface>> wallsFor(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, float supportRadius) {
  std::vector<std::shared_ptr<const Surface>> walls;
  for (const auto& surface : surfaces) {
    const std::shared_ptr<const Surface> wall = surface->forSupport(supportRadius);
    walls.push_back(wall != nullptr ? wall : surface);
  }
  return walls;
}

bool projectAlongNormals(const Surface& surface, Vec3f& p, float margin) {
  constexpr int kRounds = 8;
  bool moved = false;
  Vec3f before = p;
  for (int round = 0; round < kRounds; ++round) {
    Vec3f normal;
    const float missing = margin - surface.distance(p, normal);
    if (missing <= 1e-4F * margin) return moved;
    before = p;
    p += missing * normal;
    moved = true;
  }
  // To and fro between two parts of the wall: midway.
  p = 0.5F * (before + p);
  return true;
}

float DistanceSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const double step = 1e-6 * bounds().size().norm();
  const Vec3d at = p.cast<double>();
  Vec3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d offset = step * Vec3d::Unit(axis);
    gradient[axis] = signedDistance(at + offset) - signedDistance(at - offset);
  }
  normal = gradient.isZero(0) ? Vec3f(Vec3f::UnitY()) : Vec3f(gradient.normalized().cast<float>());
  return static_cast<float>(signedDistance(at));
}

void DistanceSurface::firstHits(const Vec3f& origin, const Directions& directions,
                                std::span<float> hits) const {
  constexpr int kMostSteps = 128;
  constexpr float kTouching = 1e-5F;
  const auto distanceAt = [this](const Vec3f& p) {
    return static_cast<float>(signedDistance(p.cast<double>()));
  };
  const auto across = static_cast<float>(bounds().size().norm());
  const float start = std::max(distanceAt(origin), 0.0F);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const Vec3f direction(directions.x[k], directions.y[k], directions.z[k]);
    float at = start, left = start;
    for (int step = 0; step < kMostSteps && at < hits[k] && at < start + across && left > kTouching * across;
         ++step) {
      left = distanceAt(origin + at * direction);
      at += std::max(left, 0.0F);
    }
    if (left <= kTouching * across) hits[k] = std::min(hits[k], at);
  }
}

void Surface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  Vec3f normal;
  const float d = distance(p, normal);
  if (std::abs(d) < reach) out.push_back({normal, d, p - d * normal});
}

}  // namespace migiwa
