#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <unordered_map>

#include <Eigen/Geometry>

#include "core/base/messages.h"
#include "core/slim/shape_import.h"

namespace migiwa {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::string at(const Vec3f& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

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

void dropUseless(TriangleMesh& mesh, std::vector<std::string>& notes) {
  const std::size_t all = mesh.triangles.size();
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (const std::size_t flat = all - mesh.triangles.size(); flat > 0)
    notes.push_back(counted(flat, "triangle with two corners at the same place was",
                            "triangles with two corners at the same place were") +
                    " left out");
  std::set<Triangle> known;
  const std::size_t before = mesh.triangles.size();
  std::erase_if(mesh.triangles, [&](Triangle t) {
    std::sort(t.begin(), t.end());
    return !known.insert(t).second;
  });
  if (const std::size_t twice = before - mesh.triangles.size(); twice > 0)
    notes.push_back(
        counted(twice, "triangle that is there twice was", "triangles that are there twice were") +
        " left out");
}

/// The triangles on both sides of every edge.
class Edges {
 public:
  struct Side {
    std::uint32_t triangle = kNone;
    bool forward = true;  ///< whether the triangle runs along the edge from its smaller to its larger vertex
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  Edges(const TriangleMesh& mesh, const std::string& place) {
    sides_.reserve(mesh.triangles.size() * 3 / 2);
    std::size_t crowded = 0;
    std::uint64_t firstCrowded = 0;
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t a = mesh.triangles[k][corner], b = mesh.triangles[k][(corner + 1) % 3];
        auto& sides = sides_[key(a, b)];
        const auto free =
            std::find_if(sides.begin(), sides.end(), [](const Side& s) { return s.triangle == kNone; });
        if (free == sides.end()) {
          if (crowded++ == 0) firstCrowded = key(a, b);
        } else {
          *free = {k, a < b};
        }
      }
    }
    if (crowded > 0) {
      const Vec3f middle =
          0.5F * (mesh.vertices[firstCrowded >> 32] + mesh.vertices[firstCrowded & 0xFFFFFFFFU]);
      throw InputError(place, "expected edges of at most two triangles (a manifold), found " +
                                  counted(crowded, "triangle", "triangles") +
                                  " more on edges that have two already, the first at " + at(middle));
    }
  }

  const std::array<Side, 2>& of(std::uint32_t a, std::uint32_t b) const { return sides_.at(key(a, b)); }

  /// Number of edges with one triangle only, and the middle of one of them.
  std::size_t open(const TriangleMesh& mesh, Vec3f& middle) const {
    std::size_t count = 0;
    std::uint64_t first = 0;
    for (const auto& [edge, sides] : sides_) {
      if (sides[1].triangle != kNone) continue;
      if (count++ == 0 || edge < first) first = edge;
    }
    if (count > 0) middle = 0.5F * (mesh.vertices[first >> 32] + mesh.vertices[first & 0xFFFFFFFFU]);
    return count;
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
  }
  std::unordered_map<std::uint64_t, std::array<Side, 2>> sides_;
};

/// A connected part of the mesh: which triangles, and which of them face the other way than its first one.
struct Part {
  std::vector<std::uint32_t> triangles;
  std::vector<bool> turned;
};

std::vector<Part> connectedParts(const TriangleMesh& mesh, const Edges& edges, const std::string& place) {
  std::vector<Part> parts;
  enum : std::uint8_t { unknown, same, opposite };
  std::vector<std::uint8_t> state(mesh.triangles.size(), unknown);
  for (std::uint32_t start = 0; start < mesh.triangles.size(); ++start) {
    if (state[start] != unknown) continue;
    Part part;
    part.triangles.push_back(start);
    state[start] = same;
    for (std::size_t k = 0; k < part.triangles.size(); ++k) {
      const std::uint32_t triangle = part.triangles[k];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t a = mesh.triangles[triangle][corner],
                            b = mesh.triangles[triangle][(corner + 1) % 3];
        const auto& sides = edges.of(a, b);
        if (sides[1].triangle == Edges::kNone) continue;
        const std::uint32_t other = sides[0].triangle == triangle ? sides[1].triangle : sides[0].triangle;
        // Neighbours that face the same way run along their edge in opposite directions.
        const bool agree = sides[0].forward != sides[1].forward;
        const std::uint8_t wanted = (state[triangle] == same) == agree ? same : opposite;
        if (state[other] == unknown) {
          state[other] = wanted;
          part.triangles.push_back(other);
        } else if (state[other] != wanted) {
          throw InputError(place, "expected a surface with two sides, found one like a Moebius strip at " +
                                      at(mesh.vertices[a]));
        }
      }
    }
    for (const std::uint32_t triangle : part.triangles) part.turned.push_back(state[triangle] == opposite);
    parts.push_back(std::move(part));
  }
  return parts;
}

double signedVolume(const TriangleMesh& mesh, const Part& part) {
  const Vec3d origin = mesh.vertices[mesh.triangles[part.triangles[0]][0]].cast<double>();
  double volume = 0;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[part.triangles[k]];
    const Vec3d a = mesh.vertices[t[0]].cast<double>() - origin,
                b = mesh.vertices[t[1]].cast<double>() - origin,
                c = mesh.vertices[t[2]].cast<double>() - origin;
    volume += (part.turned[k] ? -1 : 1) * a.dot(b.cross(c)) / 6;
  }
  return volume;
}

/// Whether p lies inside the closed part: a ray in a direction that no modeller would choose crosses it an
/// odd number of times.
bool contains(const TriangleMesh& mesh, const Part& part, const Vec3d& p) {
  const Vec3d direction = Vec3d(0.5377, 0.8338, -0.1259).normalized();
  int crossings = 0;
  for (const std::uint32_t triangle : part.triangles) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3d a = mesh.vertices[t[0]].cast<double>();
    const Vec3d ab = mesh.vertices[t[1]].cast<double>() - a, ac = mesh.vertices[t[2]].cast<double>() - a;
    const Vec3d across = direction.cross(ac);
    const double determinant = ab.dot(across);
    if (std::abs(determinant) < 1e-300) continue;
    const Vec3d offset = p - a, side = offset.cross(ab);
    const double u = offset.dot(across) / determinant, v = direction.dot(side) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && ac.dot(side) / determinant > 0) ++crossings;
  }
  return crossings % 2 == 1;
}

/// Whether the part lies in `other` as a whole, as far as some of its vertices tell: parts that cross do not.
bool liesWithin(const TriangleMesh& mesh, const Part& part, const Part& other) {
  constexpr std::size_t kVertices = 32;
  const std::size_t stride = std::max<std::size_t>(1, part.triangles.size() / kVertices);
  for (std::size_t k = 0; k < part.triangles.size(); k += stride)
    if (!contains(mesh, other, mesh.vertices[mesh.triangles[part.triangles[k]][0]].cast<double>()))
      return false;
  return true;
}

/// Beyond this many parts their nesting is not looked at: that takes the square of their number.
constexpr std::size_t kMostNestedParts = 200;

void orient(TriangleMesh& mesh, std::vector<Part>& parts, bool closed, std::vector<std::string>& notes) {
  std::size_t turned = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Part& part = parts[k];
    bool flip = false;
    if (closed) {
      int depth = 0;
      for (std::size_t other = 0; other < parts.size() && parts.size() <= kMostNestedParts; ++other)
        if (other != k && liesWithin(mesh, part, parts[other])) ++depth;
      // A part within another one is the wall of a hollow.
      flip = (signedVolume(mesh, part) < 0) != (depth % 2 == 1);
    } else {
      const auto opposed = static_cast<std::size_t>(std::count(part.turned.begin(), part.turned.end(), true));
      flip = 2 * opposed > part.turned.size();
    }
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      if (part.turned[t] == flip) continue;
      Triangle& triangle = mesh.triangles[part.triangles[t]];
      std::swap(triangle[1], triangle[2]);
      ++turned;
    }
  }
  if (turned > 0)
    notes.push_back(counted(turned, "triangle was", "triangles were") +
                    " turned to face outwards as the others do");
}

}  // namespace

bool repairMesh(TriangleMesh& mesh, const std::string& place, std::vector<std::string>& notes) {
  weld(mesh);
  dropUseless(mesh, notes);
  if (mesh.triangles.size() < 4)
    throw InputError(place, "expected at least 4 triangles, found " + std::to_string(mesh.triangles.size()) +
                                "; a box or a plane is a shape of its own");
  const Edges edges(mesh, place);
  std::vector<Part> parts = connectedParts(mesh, edges, place);
  Vec3f hole = Vec3f::Zero();
  const std::size_t open = edges.open(mesh, hole);
  orient(mesh, parts, open == 0, notes);
  if (open > 0)
    notes.push_back(
        "the mesh is open: " + counted(open, "edge has", "edges have") +
        " a triangle on one side only, the first near " + at(hole) +
        "; inside and outside are known near its surface only, by how most of its triangles are wound");
  return open == 0;
}

}  // namespace migiwa
