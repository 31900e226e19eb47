#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <utility>

#include "core/base/messages.h"
#include "core/slim/shape_import.h"

namespace migiwa {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

void weld(TriangleMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), same(mesh.vertices.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3f &p = mesh.vertices[a], &q = mesh.vertices[b];
    if (p.x() != q.x()) return p.x() < q.x();
    if (p.y() != q.y()) return p.y() < q.y();
    return p.z() < q.z();
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return before(a, b) || (!before(b, a) && a < b); });
  std::vector<Vec3f> kept;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || before(order[k - 1], order[k])) kept.push_back(mesh.vertices[order[k]]);
    same[order[k]] = static_cast<std::uint32_t>(kept.size() - 1);
  }
  mesh.vertices = std::move(kept);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = same[corner];
}

/// Corners nearer to each other than this share of the mesh's diagonal are one: files write so many digits.
constexpr double kWelded = 1e-6;

/// Welds corners that nearly meet, each to the first of those that it hangs together with. After weld().
void weldNear(TriangleMesh& mesh, std::vector<std::string>& notes) {
  const double reach = kWelded * mesh.bounds().size().norm();
  if (!(reach > 0)) return;
  const NearPoints near(mesh.vertices, reach);
  DisjointSets same(mesh.vertices.size());
  std::size_t welded = 0;
  for (std::uint32_t k = 0; k < mesh.vertices.size(); ++k)
    near.within(mesh.vertices[k], [&](std::uint32_t other) {
      if (same.join(k, other)) ++welded;
      return true;
    });
  if (welded == 0) return;
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = same.least(corner);
  std::ostringstream text;
  text.precision(2);
  text << counted(welded, "corner was", "corners were") << " welded to others within " << reach
       << " m, a millionth of the mesh's size";
  notes.push_back(text.str());
}

/// Leaves out vertices of no triangle.
void dropVertices(TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> place(mesh.vertices.size(), kUnused);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) place[corner] = 0;
  std::uint32_t used = 0;
  for (std::size_t k = 0; k < place.size(); ++k) {
    if (place[k] == kUnused) continue;
    mesh.vertices[used] = mesh.vertices[k];
    place[k] = used++;
  }
  mesh.vertices.resize(used);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = place[corner];
}

void dropFlat(TriangleMesh& mesh, std::vector<std::string>& notes) {
  const std::size_t all = mesh.triangles.size();
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (const std::size_t flat = all - mesh.triangles.size(); flat > 0)
    notes.push_back(counted(flat, "triangle with two corners at the same place was",
                            "triangles with two corners at the same place were") +
                    " left out");
}

}  // namespace

void weldMesh(TriangleMesh& mesh, std::vector<std::string>& notes) {
  weld(mesh);
  weldNear(mesh, notes);
  dropFlat(mesh, notes);
  dropVertices(mesh);
}

}  // namespace migiwa
