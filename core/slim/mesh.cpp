#include "core/slim/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace migiwa {

namespace {

/// Cells along the longest side: at least, for smooth outlines; at most, for memory.
constexpr double kFewestCells = 90, kMostCells = 220;
/// Cells between the surface and the lattice's border.
constexpr double kCellsAround = 2.5;
/// Edge of a cell over the radius of a small ball, at most.
constexpr double kDetail = 0.35;
/// Triangles that a surface of area A gets are about this times A over the square of the cell's edge.
constexpr double kTrianglesPerCell = 13.3;
/// Cells along each side of what one thread works on at a time.
constexpr int kBlock = 8;
/// The weight that a node has at the rim of its core; less of all nodes together is beyond an open surface.
constexpr float kRimWeight = 0.08F;

/// By Cauchy and Crofton: parallel lines `step` apart cross a surface of area A in A |cos| / step^2 places,
/// which for lines along the three axes add up to 3 / 2 A / step^2 for a surface that faces all ways evenly.
double areaOf(const SlimModel& model, const Bounds& bounds) {
  constexpr double kLines = 64;
  const double step = bounds.size().maxCoeff() / kLines;
  const Eigen::Vector3i count = (bounds.size().array() / step).ceil().cast<int>() + 1;
  long crossings = 0;
  std::vector<bool> before(static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y()));
  for (int z = 0; z < count.z(); ++z) {
    for (int y = 0; y < count.y(); ++y) {
      for (int x = 0; x < count.x(); ++x) {
        const Vec3d p = bounds.min + step * Vec3d(x, y, z);
        const bool inside = model.coarseDistance(p.cast<float>()) < 0;
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(count.x()),
                          at = row + static_cast<std::size_t>(x);
        if (z > 0) crossings += before[at] != inside ? 1 : 0;
        before[at] = inside;
        if (x > 0) crossings += before[at - 1] != inside ? 1 : 0;
        if (y > 0) crossings += before[at - static_cast<std::size_t>(count.x())] != inside ? 1 : 0;
      }
    }
  }
  return static_cast<double>(crossings) * step * step / 1.5;
}

TetrahedraLattice latticeFor(const SlimModel& model, double mostTriangles) {
  std::vector<float> radii;
  for (const SlimNode& node : model.nodes()) radii.push_back(node.radius);
  const auto quarter = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 4);
  std::nth_element(radii.begin(), quarter, radii.end());
  Bounds bounds = model.bounds().grown(static_cast<double>(*quarter));
  const double extent = bounds.size().maxCoeff();
  const double cell =
      std::max({std::min(kDetail * static_cast<double>(*quarter), extent / kFewestCells), extent / kMostCells,
                std::sqrt(kTrianglesPerCell * areaOf(model, bounds) / mostTriangles)});
  bounds = bounds.grown(kCellsAround * cell);
  return {bounds.min.cast<float>(), static_cast<float>(cell),
          (bounds.size().array() / cell).ceil().cast<int>().matrix()};
}

/// Pairs of lattice points, the smaller number first, with the surface between them.
using EdgeKey = std::uint64_t;
using EdgeTriangle = std::array<EdgeKey, 3>;

EdgeKey edgeKey(std::uint32_t a, std::uint32_t b) {
  return static_cast<EdgeKey>(std::min(a, b)) << 32U | std::max(a, b);
}

/// The triangles of one tetrahedron.
void cutTetrahedron(const TetrahedraLattice::Tetrahedron& corners, const std::vector<float>& distances,
                    std::vector<EdgeTriangle>& out) {
  unsigned inside = 0;
  int count = 0;
  for (unsigned k = 0; k < 4; ++k) {
    if (!(distances[corners[k]] < 0)) continue;
    inside |= 1U << k;
    ++count;
  }
  if (count == 0 || count == 4) return;
  // Even permutations of the corners, so that all keep the orientation of the first.
  static constexpr std::array<std::array<std::uint8_t, 4>, 4> kFirst{
      {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}}};
  static constexpr std::array<std::array<std::uint8_t, 4>, 6> kPair{
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};
  const auto edge = [&](std::uint8_t a, std::uint8_t b) { return edgeKey(corners[a], corners[b]); };
  if (count == 2) {
    for (const auto& [a, b, c, d] : kPair) {
      if (inside != (1U << a | 1U << b)) continue;
      out.push_back({edge(a, c), edge(a, d), edge(b, d)});
      out.push_back({edge(a, c), edge(b, d), edge(b, c)});
    }
    return;
  }
  const unsigned alone = count == 1 ? inside : inside ^ 15U;
  for (const auto& [a, b, c, d] : kFirst) {
    if (alone != 1U << a) continue;
    if (count == 1)
      out.push_back({edge(a, b), edge(a, c), edge(a, d)});
    else
      out.push_back({edge(a, b), edge(a, d), edge(a, c)});
  }
}

/// Work on the lattice block by block; the blocks near the surface alone know distances.
class Extraction {
 public:
  Extraction(const SlimModel& model, const TetrahedraLattice& lattice, ThreadPool& pool)
      : model_(model), lattice_(lattice), pool_(pool), distances_(lattice.points()) {
    blocks_ = ((lattice.size().array() + kBlock - 1) / kBlock).matrix();
    const auto count = static_cast<std::size_t>(blocks_.prod());
    near_.assign(count, 0);
    pool_.run(count, [&](std::size_t block) { near_[block] = measure(block) ? 1 : 0; });
  }

  std::vector<EdgeTriangle> triangles() {
    std::vector<std::vector<EdgeTriangle>> parts(near_.size());
    pool_.run(near_.size(), [&](std::size_t block) {
      if (near_[block] == 0) return;
      visitCells(block, [&](const Eigen::Vector3i& at) {
        lattice_.visitTetrahedra(at, [&](const TetrahedraLattice::Tetrahedron& corners) {
          cutTetrahedron(corners, distances_, parts[block]);
        });
      });
    });
    std::vector<EdgeTriangle> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  /// Where the surface crosses an edge, by false position (Illinois); whether it truly does.
  bool crossing(EdgeKey key, Vec3f& position, Vec3f& normal) const {
    const auto from = static_cast<std::uint32_t>(key >> 32U), to = static_cast<std::uint32_t>(key);
    const Vec3f a = lattice_.position(from), b = lattice_.position(to);
    float low = 0, high = 1, atLow = distances_[from], atHigh = distances_[to];
    const float close = 1e-3F * lattice_.cell();
    float distance = 0;
    int side = 0;
    for (int round = 0; round < 20; ++round) {
      const float t = (low * atHigh - high * atLow) / (atHigh - atLow);
      position = a + std::clamp(t, 0.0F, 1.0F) * (b - a);
      const SlimModel::Nearest nearest = model_.nearest(position);
      normal = nearest.normal;
      distance = nearest.distance;
      if (std::abs(distance) < close) break;
      if ((distance < 0) == (atLow < 0)) {
        low = t, atLow = distance;
        if (side == -1) atHigh *= 0.5F;
        side = -1;
      } else {
        high = t, atHigh = distance;
        if (side == 1) atLow *= 0.5F;
        side = 1;
      }
    }
    return std::abs(distance) < close && model_.evaluate(position).weight >= kRimWeight;
  }

 private:
  template <class Visit>
  void visitCells(std::size_t block, const Visit& visit) const {
    const Eigen::Vector3i low = lowerCorner(block),
                          high = (low.array() + kBlock).min(lattice_.size().array());
    Eigen::Vector3i at;
    for (at.z() = low.z(); at.z() < high.z(); ++at.z())
      for (at.y() = low.y(); at.y() < high.y(); ++at.y())
        for (at.x() = low.x(); at.x() < high.x(); ++at.x()) visit(at);
  }
  Eigen::Vector3i lowerCorner(std::size_t block) const {
    const auto index = static_cast<int>(block);
    return kBlock * Eigen::Vector3i(index % blocks_.x(), index / blocks_.x() % blocks_.y(),
                                    index / blocks_.x() / blocks_.y());
  }

  /// Fills in the distances of a block's points; false where the surface is elsewhere, and only their sign
  /// is right.
  bool measure(std::size_t block) {
    const float cell = lattice_.cell(), error = 2 * model_.coarseError();
    const Vec3f middle =
        lattice_.position(lattice_.point(lowerCorner(block), 0)) + Vec3f::Constant(0.5F * kBlock * cell);
    const float coarse = model_.coarseDistance(middle);
    // Half the block's diagonal, and an edge of a tetrahedron that reaches out of it.
    const bool far = std::abs(coarse) > 0.87F * kBlock * cell + 1.5F * cell + error;
    visitCells(block, [&](const Eigen::Vector3i& at) {
      for (const std::uint32_t centre : {0U, 1U}) {
        const std::uint32_t point = lattice_.point(at, centre);
        float& distance = distances_[point];
        if (far) {
          distance = coarse;
          continue;
        }
        const Vec3f p = lattice_.position(point);
        distance = model_.coarseDistance(p);
        if (std::abs(distance) < error + cell) distance = model_.nearest(p).distance;
      }
    });
    return !far;
  }

  const SlimModel& model_;
  const TetrahedraLattice& lattice_;
  ThreadPool& pool_;
  Eigen::Vector3i blocks_;
  std::vector<std::uint8_t> near_;
  std::vector<float> distances_;
};

/// Takes out what is no surface though distances change their sign: beyond the rim of an open one, and, where
/// nodes contradict each other, about a few points of the lattice beside a closed one. The latter goes in
/// whole connected parts, so that what stays is closed.
void removeUnreal(std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<std::uint8_t>& real,
                  bool closed) {
  std::vector<std::uint8_t> keep = real;
  if (closed) {
    // Connected vertices have a common root, the one with the smallest number.
    std::vector<std::uint32_t> parent(real.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto rootOf = [&](std::uint32_t at) {
      while (parent[at] != at) at = parent[at] = parent[parent[at]];
      return at;
    };
    for (const auto& [a, b, c] : triangles) {
      for (const std::uint32_t other : {b, c}) {
        const std::uint32_t p = rootOf(a), q = rootOf(other);
        parent[std::max(p, q)] = std::min(p, q);
      }
    }
    std::vector<long> balance(real.size());  // real vertices minus the others
    for (std::uint32_t k = 0; k < real.size(); ++k) balance[rootOf(k)] += real[k] != 0 ? 1 : -1;
    for (std::uint32_t k = 0; k < real.size(); ++k) keep[k] = balance[rootOf(k)] > 0 ? 1 : 0;
  }
  std::erase_if(triangles, [&](const auto& corners) {
    return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t k) { return keep[k] == 0; });
  });
}

/// Takes out vertices that no triangle has.
void removeLoose(SlimMesh& mesh) {
  constexpr std::uint32_t kLoose = ~0U;
  std::vector<std::uint32_t> place(mesh.surface.vertices.size(), kLoose);
  for (const auto& corners : mesh.surface.triangles)
    for (const std::uint32_t k : corners) place[k] = 0;
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < place.size(); ++k) {
    if (place[k] == kLoose) continue;
    place[k] = count;
    mesh.surface.vertices[count] = mesh.surface.vertices[k];
    mesh.normals[count] = mesh.normals[k];
    ++count;
  }
  mesh.surface.vertices.resize(count);
  mesh.normals.resize(count);
  for (auto& corners : mesh.surface.triangles)
    for (std::uint32_t& k : corners) k = place[k];
}

}  // namespace

SlimMesh extractSlimMesh(const SlimModel& model, ThreadPool& pool, double mostTriangles) {
  SlimMesh mesh;
  if (model.nodes().empty()) return mesh;
  const TetrahedraLattice lattice = latticeFor(model, mostTriangles);
  Extraction extraction(model, lattice, pool);
  const std::vector<EdgeTriangle> triangles = extraction.triangles();

  std::vector<EdgeKey> edges;
  edges.reserve(3 * triangles.size());
  for (const EdgeTriangle& triangle : triangles) edges.insert(edges.end(), triangle.begin(), triangle.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  mesh.surface.vertices.resize(edges.size());
  mesh.normals.resize(edges.size());
  std::vector<std::uint8_t> real(edges.size());
  parallelFor(pool, edges.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k)
      real[k] = extraction.crossing(edges[k], mesh.surface.vertices[k], mesh.normals[k]) ? 1 : 0;
  });
  for (const EdgeTriangle& triangle : triangles) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), triangle[k]) -
                                              edges.begin());
    mesh.surface.triangles.push_back(corners);
  }
  removeUnreal(mesh.surface.triangles, real, model.closed());
  removeLoose(mesh);
  return mesh;
}

}  // namespace migiwa
