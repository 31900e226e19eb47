#include "core/slim/mesh_sampling.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/slim/random_sequence.h"

namespace migiwa {

std::size_t sampleCount(const TriangleMesh& mesh, int nodes) {
  // Small balls hold a dozen triangles' worth of surface each and overlap eightfold; every one needs a few
  // dozen points.
  const std::size_t forNodes = 12 * static_cast<std::size_t>(std::max(nodes, 0));
  return std::clamp(std::max(4 * mesh.triangles.size(), forNodes), std::size_t{200000}, std::size_t{2000000});
}

std::vector<OrientedPoint> samplePoints(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<Vec3f> normals(mesh.triangles.size());
  std::vector<double> areas(mesh.triangles.size());
  double total = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& [a, b, c] = mesh.triangles[k];
    const Vec3d across = (mesh.vertices[b] - mesh.vertices[a])
                             .cast<double>()
                             .cross((mesh.vertices[c] - mesh.vertices[a]).cast<double>());
    areas[k] = 0.5 * across.norm();
    total += areas[k];
    normals[k] = across.normalized().cast<float>();
  }
  std::vector<OrientedPoint> points;
  if (!(total > 0)) return points;
  points.reserve(count + mesh.triangles.size() / 2);
  RandomSequence random(seed);
  // A point each time the area passed reaches the next multiple of a share, so that neighbouring triangles of
  // a strip share them evenly.
  const double share = total / static_cast<double>(count);
  double next = random.unit() * share, passed = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& [a, b, c] = mesh.triangles[k];
    passed += areas[k];
    // Roberts' R2 sequence, begun at random, folded into the triangle.
    double u = random.unit(), v = random.unit();
    for (; next < passed; next += share) {
      u += 0.7548776662466927, v += 0.5698402909980532;
      u -= std::floor(u), v -= std::floor(v);
      const bool folded = u + v > 1;
      const auto s = static_cast<float>(folded ? 1 - u : u), t = static_cast<float>(folded ? 1 - v : v);
      points.push_back({mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]) +
                            t * (mesh.vertices[c] - mesh.vertices[a]),
                        normals[k]});
    }
  }
  return points;
}

}  // namespace migiwa
