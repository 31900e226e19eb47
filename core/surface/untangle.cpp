// Triangles that pass through each other: sheets of the surface that come near each other, and folds.
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/surface/grid.h"

namespace migiwa::surface {

namespace {

/// Less than this is touching, in particle spacings.
constexpr float kTouching = 5e-4F;
constexpr int kUntanglingRounds = 8, kRoundsBack = 3;
/// Triangles of a smooth sheet, whose normals have a larger product, do not meet.
constexpr float kSameSheet = 0.9F;

using Corners = std::array<Vec3f, 3>;

/// Whether the way from p to q passes through the inside of a triangle, by more than `depth` on both sides of
/// it and away from its edges.
bool passesThrough(const Vec3f& p, const Vec3f& q, const Corners& triangle, const Vec3f& normal,
                   float depth) {
  const float above = normal.dot(p - triangle[0]), below = normal.dot(q - triangle[0]);
  if (above * below >= 0 || std::min(std::abs(above), std::abs(below)) < depth) return false;
  const Vec3f at = p + above / (above - below) * (q - p);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3f edge = triangle[(k + 1) % 3] - triangle[k];
    if (normal.dot(edge.cross(at - triangle[k])) < depth * edge.norm()) return false;
  }
  return true;
}

/// A triangle's box and normal, for what is asked of most pairs of triangles.
struct Shape {
  Float4 middle, half;  ///< of the box (m)
  Float4 normal;        ///< unit

  bool mayMeet(const Shape& other) const {
    return std::abs(other.middle.x - middle.x) <= half.x + other.half.x &&
           std::abs(other.middle.y - middle.y) <= half.y + other.half.y &&
           std::abs(other.middle.z - middle.z) <= half.z + other.half.z &&
           normal.x * other.normal.x + normal.y * other.normal.y + normal.z * other.normal.z <= kSameSheet;
  }
};

class Untangler {
 public:
  Untangler(RawMesh& mesh, const std::vector<Vec3f>& found, const Grid& grid, ThreadPool& pool)
      : mesh_(mesh), found_(found), grid_(grid), pool_(pool), depth_(kTouching * grid.spacing()) {}

  void run() {
    std::vector<char> active(mesh_.triangles.size(), 1);
    bool all = true;
    for (int round = 0; round < kUntanglingRounds; ++round) {
      measure();
      const std::vector<std::uint32_t> tangled = tangledVertices(active, all);
      if (tangled.empty()) return;
      for (const std::uint32_t v : tangled) pullBack(v, round);
      std::vector<char> moved(mesh_.positions.size(), 0);
      for (const std::uint32_t v : tangled) moved[v] = 1;
      for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh_.triangles[t];
        active[t] = static_cast<char>(moved[a] | moved[b] | moved[c]);
      }
      all = false;
    }
  }

 private:
  Corners cornersOf(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
  }

  /// Boxes and normals, along a grid of the middles of the boxes.
  void measure() {
    const std::size_t n = mesh_.triangles.size();
    middles_.resize(n), shapes_.resize(n);
    std::vector<Shape> shapes(n);
    parallelFor(pool_, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) {
        const Corners p = cornersOf(static_cast<std::uint32_t>(t));
        const Vec3f area = (p[1] - p[0]).cross(p[2] - p[0]), low = p[0].cwiseMin(p[1]).cwiseMin(p[2]),
                    high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
        const float size = area.norm();
        middles_[t] = Float4(Vec3f(0.5F * (low + high)));
        shapes[t] = {middles_[t], Float4(Vec3f(0.5F * (high - low))),
                     Float4(size > 0 ? Vec3f(area / size) : Vec3f(Vec3f::Zero()))};
      }
    });
    largest_ = Vec3f::Zero();
    for (const Shape& shape : shapes) largest_ = largest_.cwiseMax(shape.half.xyz());
    cells_.build(middles_, largest_.maxCoeff(), pool_);
    parallelFor(pool_, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t place = begin; place < end; ++place) shapes_[place] = shapes[cells_.order()[place]];
    });
  }

  /// The vertices of triangles that pass through each other, one of them active.
  std::vector<std::uint32_t> tangledVertices(const std::vector<char>& active, bool all) {
    std::vector<std::vector<std::uint32_t>> found(chunkCount(shapes_.size()));
    parallelFor(pool_, shapes_.size(), [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      for (std::size_t place = begin; place < end; ++place)
        if (active[cells_.order()[place]] != 0) meet(place, all, found[chunk]);
    });
    std::vector<std::uint32_t> vertices;
    for (const auto& part : found) vertices.insert(vertices.end(), part.begin(), part.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  /// Adds the vertices of a triangle and of all that pass through it or that it passes through; of those that
  /// come later along the grid where they all ask the same.
  void meet(std::size_t place, bool all, std::vector<std::uint32_t>& out) const {
    const Shape& shape = shapes_[place];
    const Vec3f middle = shape.middle.xyz(), reach = 1.0001F * (shape.half.xyz() + largest_);
    const CellGrid::Cell low = cells_.cellOf(Float4(Vec3f(middle - reach))),
                         high = cells_.cellOf(Float4(Vec3f(middle + reach)));
    const std::uint32_t from = all ? static_cast<std::uint32_t>(place) + 1 : 0;
    for (int z = low.z; z <= high.z; ++z) {
      for (int y = low.y; y <= high.y; ++y) {
        const auto row = cells_.row(low.x, high.x, y, z);
        for (std::uint32_t k = std::max(row.from, from); k < row.to; ++k) {
          if (!shape.mayMeet(shapes_[k])) continue;
          const std::uint32_t one = cells_.order()[place], other = cells_.order()[k];
          if (!cross(one, other, shape.normal.xyz(), shapes_[k].normal.xyz())) continue;
          out.insert(out.end(), mesh_.triangles[one].begin(), mesh_.triangles[one].end());
          out.insert(out.end(), mesh_.triangles[other].begin(), mesh_.triangles[other].end());
        }
      }
    }
  }

  bool cross(std::uint32_t one, std::uint32_t other, const Vec3f& oneNormal, const Vec3f& otherNormal) const {
    const auto &a = mesh_.triangles[one], &b = mesh_.triangles[other];
    for (const std::uint32_t v : a)
      if (v == b[0] || v == b[1] || v == b[2]) return false;
    const Corners p = cornersOf(one), q = cornersOf(other);
    for (std::size_t k = 0; k < 3; ++k)
      if (passesThrough(p[k], p[(k + 1) % 3], q, otherNormal, depth_) ||
          passesThrough(q[k], q[(k + 1) % 3], p, oneNormal, depth_))
        return true;
    return false;
  }

  void pullBack(std::uint32_t v, int round) {
    const Hold hold = mesh_.holds[v];
    Vec3f& p = mesh_.positions[v];
    const Vec3f middle = mesh_.cells[v] + Vec3f::Constant(0.5F * grid_.cell());
    Vec3f to = p + 0.5F * ((round < kRoundsBack ? found_[v] : middle) - p);
    if (hold == Hold::edge) to = p + mesh_.along[v].dot(to - p) * mesh_.along[v];
    if (hold != Hold::none) {
      grid_.ontoWall(to);
      if (std::abs(grid_.boundary()->distance(to)) > std::abs(grid_.boundary()->distance(p))) return;
    }
    p = to;
  }

  RawMesh& mesh_;
  const std::vector<Vec3f>& found_;
  const Grid& grid_;
  ThreadPool& pool_;
  float depth_;
  Vec3f largest_ = Vec3f::Zero();  ///< half of the largest box along each axis (m)
  CellGrid cells_;
  std::vector<Float4> middles_;
  std::vector<Shape> shapes_;  ///< along the grid
};

}  // namespace

void untangle(RawMesh& mesh, const std::vector<Vec3f>& found, const Grid& grid, ThreadPool& pool) {
  if (!mesh.triangles.empty()) Untangler(mesh, found, grid, pool).run();
}

}  // namespace migiwa::surface
