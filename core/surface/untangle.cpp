// Triangles that pass through each other: sheets of the surface that come near each other, and folds.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

class Untangler {
 public:
  Untangler(RawMesh& mesh, const std::vector<Vec3f>& found, const Grid& grid, ThreadPool& pool)
      : mesh_(mesh), found_(found), grid_(grid), pool_(pool), depth_(kTouching * grid.spacing()) {}

  void run() {
    std::vector<std::uint32_t> active(mesh_.triangles.size());
    std::iota(active.begin(), active.end(), 0U);
    for (int round = 0; round < kUntanglingRounds && !active.empty(); ++round) {
      measure();
      const std::vector<std::uint32_t> tangled = tangledVertices(active);
      if (tangled.empty()) return;
      for (const std::uint32_t v : tangled) pullBack(v, round);
      std::vector<char> moved(mesh_.positions.size(), 0);
      for (const std::uint32_t v : tangled) moved[v] = 1;
      active.clear();
      for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh_.triangles[t];
        if (moved[a] + moved[b] + moved[c] != 0) active.push_back(t);
      }
    }
  }

 private:
  Corners cornersOf(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]};
  }

  /// Normals, boxes, and a grid of the middles of the boxes.
  void measure() {
    const std::size_t n = mesh_.triangles.size();
    normals_.resize(n), middles_.resize(n), halves_.resize(n);
    parallelFor(pool_, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t t = begin; t < end; ++t) {
        const Corners p = cornersOf(static_cast<std::uint32_t>(t));
        const Vec3f area = (p[1] - p[0]).cross(p[2] - p[0]), low = p[0].cwiseMin(p[1]).cwiseMin(p[2]),
                    high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
        const float size = area.norm();
        normals_[t] = Float4(size > 0 ? Vec3f(area / size) : Vec3f(Vec3f::Zero()));
        middles_[t] = Float4(Vec3f(0.5F * (low + high)));
        halves_[t] = Float4(Vec3f(0.5F * (high - low)));
      }
    });
    float reach = 0;
    for (const Float4& half : halves_) reach = std::max({reach, half.x, half.y, half.z});
    reach_ = 2 * reach;
    cells_.build(middles_, reach_, pool_);
  }

  std::vector<std::uint32_t> tangledVertices(const std::vector<std::uint32_t>& active) {
    std::vector<std::vector<std::uint32_t>> found(chunkCount(active.size()));
    parallelFor(pool_, active.size(), [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      for (std::size_t k = begin; k < end; ++k) meet(active[k], found[chunk]);
    });
    std::vector<std::uint32_t> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Adds the vertices of a triangle and of all that pass through it or that it passes through.
  void meet(std::uint32_t t, std::vector<std::uint32_t>& out) const {
    const Float4 &middle = middles_[t], &half = halves_[t], &normal = normals_[t];
    const CellGrid::Cell cell = cells_.cellOf(middle);
    for (int z = cell.z - 1; z <= cell.z + 1; ++z) {
      for (int y = cell.y - 1; y <= cell.y + 1; ++y) {
        const auto row = cells_.row(cell.x - 1, cell.x + 1, y, z);
        for (std::uint32_t k = row.from; k < row.to; ++k) {
          const std::uint32_t other = cells_.order()[k];
          const Float4 &at = middles_[other], &size = halves_[other], &to = normals_[other];
          if (std::abs(at.x - middle.x) > half.x + size.x || std::abs(at.y - middle.y) > half.y + size.y ||
              std::abs(at.z - middle.z) > half.z + size.z)
            continue;
          if (normal.x * to.x + normal.y * to.y + normal.z * to.z > kSameSheet) continue;
          if (cross(t, other)) {
            out.insert(out.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
            out.insert(out.end(), mesh_.triangles[other].begin(), mesh_.triangles[other].end());
          }
        }
      }
    }
  }

  bool cross(std::uint32_t one, std::uint32_t other) const {
    const auto &a = mesh_.triangles[one], &b = mesh_.triangles[other];
    for (const std::uint32_t v : a)
      if (v == b[0] || v == b[1] || v == b[2]) return false;
    const Corners p = cornersOf(one), q = cornersOf(other);
    for (std::size_t k = 0; k < 3; ++k)
      if (passesThrough(p[k], p[(k + 1) % 3], q, normals_[other].xyz(), depth_) ||
          passesThrough(q[k], q[(k + 1) % 3], p, normals_[one].xyz(), depth_))
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
  float depth_, reach_ = 0;
  CellGrid cells_;
  std::vector<Float4> normals_, middles_, halves_;
};

}  // namespace

void untangle(RawMesh& mesh, const std::vector<Vec3f>& found, const Grid& grid, ThreadPool& pool) {
  if (!mesh.triangles.empty()) Untangler(mesh, found, grid, pool).run();
}

}  // namespace migiwa::surface
