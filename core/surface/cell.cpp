#include "core/surface/cell.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace migiwa::surface {

namespace {

constexpr Sheets makeSheets() {
  Sheets sheets{};
  for (int config = 0; config < 256; ++config) {
    const auto c = static_cast<std::size_t>(config);
    // The two edges that the surface goes on to from each, one through either face.
    std::array<std::array<int, 2>, kEdges> next{};
    std::array<int, kEdges> links{};
    const auto link = [&](int one, int other) {
      next[static_cast<std::size_t>(one)][static_cast<std::size_t>(links[static_cast<std::size_t>(one)]++)] =
          other;
      next[static_cast<std::size_t>(other)]
          [static_cast<std::size_t>(links[static_cast<std::size_t>(other)]++)] = one;
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const Face face = faceOf(axis, side);
        const int across = (axis + 1) % 3, up = (axis + 2) % 3;
        if (ambiguous(config, face)) {
          for (const int corner : face.corners)
            if (inside(config, corner)) link(edgeAt(across, corner), edgeAt(up, corner));
          continue;
        }
        int first = -1;
        for (std::size_t k = 0; k < 4; ++k) {
          const int from = face.corners[k], to = face.corners[(k + 1) % 4];
          if (inside(config, from) == inside(config, to)) continue;
          const int edge = edgeAt(k % 2 == 0 ? across : up, from & to);
          if (first < 0) {
            first = edge;
          } else {
            link(first, edge);
          }
        }
      }
    }
    sheets.of[c].fill(kNoSheet);
    for (int edge = 0; edge < kEdges; ++edge) {
      const auto e = static_cast<std::size_t>(edge);
      if (links[e] == 0 || sheets.of[c][e] != kNoSheet) continue;
      int at = edge, from = -1;
      while (sheets.of[c][static_cast<std::size_t>(at)] == kNoSheet) {
        sheets.of[c][static_cast<std::size_t>(at)] = sheets.count[c];
        const auto& [one, other] = next[static_cast<std::size_t>(at)];
        const int to = one != from ? one : other;
        from = at;
        at = to;
      }
      ++sheets.count[c];
    }
  }
  return sheets;
}

}  // namespace

constinit const Sheets kSheets = makeSheets();

void Nodes::load(const Grid& grid, const Block& block) {
  grid_ = &grid, block_ = &block;
  known_.fill(0);
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const int bx = x / Block::kSide, by = y / Block::kSide, bz = z / Block::kSide;
        const std::int32_t owner = block.around[static_cast<std::size_t>(13 + bx + 3 * by + 9 * bz)];
        const std::size_t n = index(x, y, z);
        if (owner < 0) {
          label[n] = Label::air, value[n] = -1, distance[n] = std::numeric_limits<float>::infinity();
          continue;
        }
        const Block& of = grid.blocks()[static_cast<std::size_t>(owner)];
        const auto m = static_cast<std::size_t>(
            Block::index(x - bx * Block::kSide, y - by * Block::kSide, z - bz * Block::kSide));
        label[n] = of.label[m], value[n] = of.value[m], distance[n] = of.distance[m];
      }
    }
  }
}

const Vec3f& Nodes::normal(int x, int y, int z) {
  const std::size_t n = index(x, y, z);
  if ((known_[n] & 1) == 0) grid_->boundary()->distance(place(x, y, z), normal_[n]);
  known_[n] |= 1;
  return normal_[n];
}

float Nodes::extended(int x, int y, int z) {
  const std::size_t n = index(x, y, z);
  if (label[n] == Label::solid && (known_[n] & 2) == 0) {
    Vec3f p = place(x, y, z);
    grid_->boundary()->project(p, 0.01F * grid_->cell());
    value[n] = grid_->valueAt(p);
    known_[n] |= 2;
  }
  return value[n];
}

namespace {

/// Walls whose normals have a smaller product than this meet in an edge.
constexpr float kSameWall = 0.95F;
/// A wall whose normal has a larger product than this with the edge of two others ends it in a corner.
constexpr float kAcross = 0.3F;

Vec3f placeOf(int corner) {
  return {static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1),
          static_cast<float>(corner >> 2 & 1)};
}

void clampToCell(Vec3f& p) {
  p = p.cwiseMax(0.0F).cwiseMin(1.0F);
}

/// A step of Newton's method for a value of zero, at most half a cell.
void step(Vec3f& p, float value, const Vec3f& gradient) {
  const float squared = gradient.squaredNorm();
  if (squared < 1e-6F) return;
  Vec3f move = -value / squared * gradient;
  if (const float length = move.norm(); length > 0.5F) move *= 0.5F / length;
  p += move;
  clampToCell(p);
}

}  // namespace

void CellSolver::enter(int x, int y, int z) {
  x_ = x, y_ = y, z_ = z;
  low_ = nodes_.place(x, y, z);
  bool air = false, solid = false;
  for (int corner = 0; corner < kCorners; ++corner) {
    air = air || labelOf(corner) == Label::air;
    solid = solid || labelOf(corner) == Label::solid;
  }
  mixed_ = air && solid;
}

Vertex CellSolver::sheet(int config, int which) {
  const auto& of = kSheets.of[static_cast<std::size_t>(config)];
  planes_.clear();
  Crossings crossings;
  for (int edge = 0; edge < kEdges; ++edge)
    if (of[static_cast<std::size_t>(edge)] == which) take(cross(config, edge), crossings);
  return solve(crossings);
}

Vertex CellSolver::part(int corner, int across, int up) {
  planes_.clear();
  Crossings crossings;
  for (const int axis : {across, up}) take(cross(1 << corner, edgeAt(axis, corner)), crossings);
  return solve(crossings);
}

CellSolver::Crossing CellSolver::cross(int config, int edge) const {
  const int lower = lowerEnd(edge), upper = lower | 1 << edge / 4;
  const int water = inside(config, lower) ? lower : upper, other = lower + upper - water;
  const bool wet = labelOf(other) == Label::solid;
  const std::size_t from = nodeOf(water), to = nodeOf(other);
  const float a = wet ? nodes_.distance[from] : nodes_.value[from],
              b = wet ? nodes_.distance[to] : nodes_.value[to];
  // A node that no wall is near has no distance: then the solid one alone tells where the wall is.
  const float part = !std::isfinite(a) ? 1 + b / grid_.cell() : a - b > 0 ? a / (a - b) : 0.5F;
  return {placeOf(water) + std::clamp(part, 0.0F, 1.0F) * (placeOf(other) - placeOf(water)), water, other,
          wet};
}

void CellSolver::take(const Crossing& crossing, Crossings& crossings) {
  crossings.sum += crossing.place;
  ++(crossing.wet ? crossings.wet : crossings.free);
  if (!crossing.wet) return;
  addPlane(crossing.water);
  const std::size_t before = planes_.size();
  addPlane(crossing.other);
  // Of a thin wall the side that faces the water counts.
  if (planes_.size() > before &&
      planes_.back().normal.dot(placeOf(crossing.water) - placeOf(crossing.other)) <= 0)
    planes_.pop_back();
}

void CellSolver::addPlane(int corner) {
  const float distance = nodes_.distance[nodeOf(corner)];
  if (!std::isfinite(distance)) return;
  const Vec3f& normal = nodes_.normal(x_ + (corner & 1), y_ + (corner >> 1 & 1), z_ + (corner >> 2 & 1));
  planes_.push_back({normal, normal.dot(placeOf(corner)) - distance / grid_.cell()});
}

Vertex CellSolver::solve(const Crossings& crossings) {
  Vertex vertex;
  vertex.cell = low_;
  Vec3f p = crossings.sum / static_cast<float>(crossings.free + crossings.wet);
  if (crossings.wet == 0) {
    toLevel(p);
  } else {
    solveAtWalls(p, crossings.free > 0, vertex);
  }
  vertex.position = low_ + grid_.cell() * p;
  return vertex;
}

void CellSolver::solveAtWalls(Vec3f& p, bool contact, Vertex& vertex) {
  const int walls = toWalls(p, vertex.along);
  vertex.hold = !contact || walls >= 3 ? Hold::still : walls == 2 ? Hold::edge : Hold::wall;
  for (int round = 0; round < 3; ++round) {
    const Vec3f normal = ontoWall(p);
    if (vertex.hold == Hold::edge) toLevelAlong(p, vertex.along);
    if (vertex.hold == Hold::wall) toLevelAlongWall(p, normal);
    clampToCell(p);
  }
  ontoWall(p);
}

/// Moves p to where the tangent planes meet, as far as they do. Returns how many walls there are, and of two
/// the direction of their edge.
int CellSolver::toWalls(Vec3f& p, Vec3f& along) {
  if (planes_.empty()) return 1;
  const Vec3f& first = planes_.front().normal;
  const Vec3f* second = nullptr;
  float least = kSameWall;
  for (const Plane& plane : planes_)
    if (const float same = plane.normal.dot(first); same < least) least = same, second = &plane.normal;
  if (second == nullptr) return 1;
  along = first.cross(*second);
  const float size = along.norm();
  if (size < 0.1F) return 1;  // the two sides of a gap
  along /= size;
  int walls = 2;
  for (const Plane& plane : planes_)
    if (std::abs(plane.normal.dot(along)) > kAcross) walls = 3;
  // The point nearest to all planes, and of those the one nearest to p: each round leaves a hundredth of the
  // way.
  constexpr float kPull = 0.01F;
  constexpr int kRounds = 3;
  Eigen::Matrix3f matrix = kPull * Eigen::Matrix3f::Identity();
  for (const Plane& plane : planes_) matrix += plane.normal * plane.normal.transpose();
  const Eigen::LDLT<Eigen::Matrix3f> solver(matrix);
  for (int round = 0; round < kRounds; ++round) {
    Vec3f right = Vec3f::Zero();
    for (const Plane& plane : planes_) right += (plane.offset - plane.normal.dot(p)) * plane.normal;
    p += solver.solve(right);
  }
  clampToCell(p);
  return walls;
}

/// Moves p onto the nearest wall, and returns the wall's normal.
Vec3f CellSolver::ontoWall(Vec3f& p) const {
  Vec3f place = low_ + grid_.cell() * p;
  const Vec3f normal = grid_.ontoWall(place);
  p = (place - low_) / grid_.cell();
  return normal;
}

/// c less the level and its gradient, trilinear within the cell.
float CellSolver::sample(const Vec3f& p, Vec3f& gradient) {
  float value = 0;
  gradient.setZero();
  for (int corner = 0; corner < kCorners; ++corner) {
    const float v = mixed_
                        ? nodes_.extended(x_ + (corner & 1), y_ + (corner >> 1 & 1), z_ + (corner >> 2 & 1))
                        : nodes_.value[nodeOf(corner)];
    Vec3f weight, slope;
    for (int axis = 0; axis < 3; ++axis) {
      const bool up = (corner >> axis & 1) != 0;
      weight[axis] = up ? p[axis] : 1 - p[axis];
      slope[axis] = up ? 1.0F : -1.0F;
    }
    value += v * weight.prod();
    gradient += v * Vec3f(slope.x() * weight.y() * weight.z(), weight.x() * slope.y() * weight.z(),
                          weight.x() * weight.y() * slope.z());
  }
  return value;
}

void CellSolver::toLevel(Vec3f& p) {
  for (int round = 0; round < 3; ++round) {
    Vec3f gradient;
    const float value = sample(p, gradient);
    step(p, value, gradient);
  }
}

void CellSolver::toLevelAlongWall(Vec3f& p, const Vec3f& normal) {
  Vec3f gradient;
  const float value = sample(p, gradient);
  step(p, value, gradient - gradient.dot(normal) * normal);
}

void CellSolver::toLevelAlong(Vec3f& p, const Vec3f& along) {
  Vec3f gradient;
  const float value = sample(p, gradient);
  step(p, value, gradient.dot(along) * along);
}

}  // namespace migiwa::surface
