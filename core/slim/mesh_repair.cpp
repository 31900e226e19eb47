#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <unordered_map>
#include <utility>

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

/// The triangles without those that are there before with the same corners, however they face.
std::vector<Triangle> withoutRepeated(const std::vector<Triangle>& triangles) {
  std::set<Triangle> known;
  std::vector<Triangle> once;
  for (const Triangle& triangle : triangles) {
    Triangle sorted = triangle;
    std::sort(sorted.begin(), sorted.end());
    if (known.insert(sorted).second) once.push_back(triangle);
  }
  return once;
}

void noteRepeated(std::size_t twice, std::vector<std::string>& notes) {
  if (twice > 0)
    notes.push_back(
        counted(twice, "triangle that is there twice was", "triangles that are there twice were") +
        " left out");
}

/// The triangles at every edge. Where parts touch, an edge has more than two: those of one part follow each
/// other in the file, so the first two are taken for neighbours, and the next two, and so on.
class Edges {
 public:
  struct Side {
    std::uint32_t triangle;
    bool forward;  ///< whether the triangle runs along the edge from its smaller to its larger vertex
  };

  explicit Edges(const TriangleMesh& mesh) {
    sides_.reserve(mesh.triangles.size() * 3 / 2);
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t a = mesh.triangles[k][corner], b = mesh.triangles[k][(corner + 1) % 3];
        sides_[key(a, b)].push_back({k, a < b});
      }
  }

  /// Takes neighbours at edges of more than two triangles by how they run along them instead.
  void pairByDirection() {
    for (auto& [edge, sides] : sides_) {
      if (sides.size() <= 2) continue;
      std::vector<Side> ahead, back;
      for (const Side& side : sides) (side.forward ? ahead : back).push_back(side);
      if (ahead.size() != back.size()) continue;
      for (std::size_t k = 0; k < ahead.size(); ++k) sides[2 * k] = ahead[k], sides[2 * k + 1] = back[k];
    }
  }

  /// The triangle on the other side of an edge, and whether both face the same way; nothing at a rim.
  std::optional<std::pair<std::uint32_t, bool>> across(std::uint32_t a, std::uint32_t b,
                                                       std::uint32_t triangle) const {
    const std::vector<Side>& sides = sides_.at(key(a, b));
    std::size_t own = 0;
    while (sides[own].triangle != triangle) ++own;
    const std::size_t other = own ^ 1U;
    if (other >= sides.size()) return std::nullopt;
    // Neighbours that face the same way run along their edge in opposite directions.
    return std::pair(sides[other].triangle, sides[own].forward != sides[other].forward);
  }

  struct Found {
    std::size_t count = 0;
    Vec3f middle = Vec3f::Zero();  ///< of one of them
  };
  /// Edges with one triangle only.
  Found open(const TriangleMesh& mesh) const {
    return count(mesh, [](std::size_t triangles) -> std::size_t { return triangles == 1 ? 1 : 0; });
  }
  /// Triangles beyond two at edges where they are no pairs.
  Found odd(const TriangleMesh& mesh) const {
    return count(mesh, [](std::size_t triangles) -> std::size_t {
      return triangles > 2 && triangles % 2 == 1 ? triangles - 2 : 0;
    });
  }
  bool crowded() const {
    return std::any_of(sides_.begin(), sides_.end(), [](const auto& edge) { return edge.second.size() > 2; });
  }

 private:
  template <class Counted>
  Found count(const TriangleMesh& mesh, const Counted& counted) const {
    Found found;
    std::uint64_t first = 0;
    for (const auto& [edge, sides] : sides_) {
      const std::size_t more = counted(sides.size());
      if (more == 0) continue;
      if (found.count == 0 || edge < first) first = edge;
      found.count += more;
    }
    if (found.count > 0)
      found.middle = 0.5F * (mesh.vertices[first >> 32] + mesh.vertices[first & 0xFFFFFFFFU]);
    return found;
  }
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
  }
  std::unordered_map<std::uint64_t, std::vector<Side>> sides_;
};

/// A connected part of the mesh: which triangles, and which of them face the other way than its first one.
struct Part {
  std::vector<std::uint32_t> triangles;
  std::vector<bool> turned;
};

/// Appends the parts of the mesh. Returns a corner at which a surface has one side only, if there is one.
std::optional<std::uint32_t> findParts(const TriangleMesh& mesh, const Edges& edges,
                                       std::vector<Part>& parts) {
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
        const auto neighbour = edges.across(a, b, triangle);
        if (!neighbour) continue;
        const auto [other, agree] = *neighbour;
        const std::uint8_t wanted = (state[triangle] == same) == agree ? same : opposite;
        if (state[other] == unknown) {
          state[other] = wanted;
          part.triangles.push_back(other);
        } else if (state[other] != wanted) {
          return a;
        }
      }
    }
    for (const std::uint32_t triangle : part.triangles) part.turned.push_back(state[triangle] == opposite);
    parts.push_back(std::move(part));
  }
  return std::nullopt;
}

std::vector<Part> connectedParts(const TriangleMesh& mesh, Edges& edges, const std::string& place) {
  std::vector<Part> parts;
  std::optional<std::uint32_t> oneSided = findParts(mesh, edges, parts);
  if (oneSided && edges.crowded()) {
    parts.clear();
    edges.pairByDirection();
    oneSided = findParts(mesh, edges, parts);
  }
  if (oneSided)
    throw InputError(place, "expected a surface with two sides, found one like a Moebius strip at " +
                                at(mesh.vertices[*oneSided]));
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

/// Whether p lies inside the closed part: a ray in a direction that no modeller would choose leaves it more
/// often than it enters, or the other way round.
bool contains(const TriangleMesh& mesh, const Part& part, const Vec3d& p) {
  const Vec3d direction = Vec3d(0.5377, 0.8338, -0.1259).normalized();
  int winding = 0;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const Triangle& t = mesh.triangles[part.triangles[k]];
    const Vec3d a = mesh.vertices[t[0]].cast<double>();
    const Vec3d ab = mesh.vertices[t[1]].cast<double>() - a, ac = mesh.vertices[t[2]].cast<double>() - a;
    const Vec3d across = direction.cross(ac);
    const double determinant = ab.dot(across);
    if (std::abs(determinant) < 1e-300) continue;
    const Vec3d offset = p - a, side = offset.cross(ab);
    const double u = offset.dot(across) / determinant, v = direction.dot(side) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && ac.dot(side) / determinant > 0)
      winding += (determinant > 0) != part.turned[k] ? 1 : -1;
  }
  return winding != 0;
}

Bounds boundsOf(const TriangleMesh& mesh, const Part& part) {
  Bounds bounds;
  for (const std::uint32_t triangle : part.triangles)
    for (const std::uint32_t corner : mesh.triangles[triangle])
      bounds.include(mesh.vertices[corner].cast<double>());
  return bounds;
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
constexpr std::size_t kMostNestedParts = 5000;

/// The part that each part lies in, the outermost one; itself for one that lies in no other.
std::vector<std::size_t> outermost(const TriangleMesh& mesh, const std::vector<Part>& parts) {
  std::vector<std::size_t> result(parts.size());
  std::vector<Bounds> bounds;
  for (const Part& part : parts) bounds.push_back(boundsOf(mesh, part));
  for (std::size_t k = 0; k < parts.size(); ++k) {
    result[k] = k;
    double largest = 0;
    for (std::size_t other = 0; other < parts.size() && parts.size() <= kMostNestedParts; ++other) {
      const double volume = bounds[other].size().prod();
      if (other == k || volume <= largest || !bounds[other].contains(bounds[k].min) ||
          !bounds[other].contains(bounds[k].max) || !liesWithin(mesh, parts[k], parts[other]))
        continue;
      result[k] = other;
      largest = volume;
    }
  }
  return result;
}

/// Which parts of a closed mesh have to be turned for the outermost ones to face outwards. Those within them
/// keep how they face relative to them: inwards is the wall of a hollow.
std::vector<bool> turnsOfClosed(const TriangleMesh& mesh, const std::vector<Part>& parts,
                                const std::vector<bool>& byMost, std::vector<std::string>& notes) {
  const std::vector<std::size_t> around = outermost(mesh, parts);
  std::vector<bool> flips;
  std::size_t needless = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t outer = around[k];
    const bool flip = signedVolume(mesh, parts[outer]) < 0;
    const bool inverted = flip != byMost[outer];
    flips.push_back(outer == k ? flip : byMost[k] != inverted);
    if (outer != k && (signedVolume(mesh, parts[k]) < 0) == flips[k]) ++needless;
  }
  if (needless > 0)
    notes.push_back(counted(needless, "part lies", "parts lie") +
                    " within others and face outwards as those do, which changes nothing: for a hollow, turn "
                    "their triangles round");
  return flips;
}

void orient(TriangleMesh& mesh, std::vector<Part>& parts, bool closed, std::vector<std::string>& notes) {
  std::vector<bool> flips;
  for (const Part& part : parts) {
    const auto opposed = static_cast<std::size_t>(std::count(part.turned.begin(), part.turned.end(), true));
    flips.push_back(2 * opposed > part.turned.size());
  }
  if (closed) flips = turnsOfClosed(mesh, parts, flips, notes);
  std::size_t turned = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Part& part = parts[k];
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      if (part.turned[t] == flips[k]) continue;
      Triangle& triangle = mesh.triangles[part.triangles[t]];
      std::swap(triangle[1], triangle[2]);
      ++turned;
    }
  }
  if (turned > 0)
    notes.push_back(counted(turned, "triangle was", "triangles were") +
                    " turned to face outwards as the others do");
}

/// Leaves out pairs of triangles with the same corners that face each other's backs: where parts touch.
void dropShared(TriangleMesh& mesh, std::vector<std::string>& notes) {
  std::map<Triangle, std::array<std::vector<std::uint32_t>, 2>> byCorners;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    Triangle t = mesh.triangles[k];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    const std::size_t way = t[1] < t[2] ? 0 : 1;
    if (way == 1) std::swap(t[1], t[2]);
    byCorners[t][way].push_back(k);
  }
  std::set<std::uint32_t> dropped;
  for (const auto& [corners, ways] : byCorners)
    for (std::size_t k = 0; k < std::min(ways[0].size(), ways[1].size()); ++k)
      dropped.insert({ways[0][k], ways[1][k]});
  if (dropped.empty()) return;
  std::vector<Triangle> kept;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k)
    if (!dropped.contains(k)) kept.push_back(mesh.triangles[k]);
  mesh.triangles = std::move(kept);
  notes.push_back(std::to_string(dropped.size()) + " triangles where parts touch were left out");
}

}  // namespace

bool repairMesh(TriangleMesh& mesh, const std::string& place, std::vector<std::string>& notes) {
  weld(mesh);
  weldNear(mesh, notes);
  dropFlat(mesh, notes);
  dropVertices(mesh);
  std::vector<Triangle> all = std::move(mesh.triangles);
  mesh.triangles = withoutRepeated(all);
  if (mesh.triangles.empty()) throw InputError(place, "expected triangles with an area, found none");
  Edges edges(mesh);
  const Edges::Found odd = edges.odd(mesh);
  if (odd.count > 0) {
    // Parts that touch have triangles with the same corners, one of each.
    std::swap(mesh.triangles, all);
    edges = Edges(mesh);
    if (edges.odd(mesh).count > 0)
      throw InputError(place,
                       "expected edges of two triangles, or of two for each part that touches there (a "
                       "manifold), found " +
                           counted(odd.count, "triangle", "triangles") +
                           " more on edges that have two already, the first at " + at(odd.middle));
  } else {
    noteRepeated(all.size() - mesh.triangles.size(), notes);
  }
  std::vector<Part> parts = connectedParts(mesh, edges, place);
  const Edges::Found open = edges.open(mesh);
  orient(mesh, parts, open.count == 0, notes);
  if (odd.count > 0) dropShared(mesh, notes);
  if (open.count > 0)
    notes.push_back(
        "the mesh is open: " + counted(open.count, "edge has", "edges have") +
        " a triangle on one side only, the first near " + at(open.middle) +
        "; its triangles as a wall end there and have fluid on both sides, a SLIM surface fitted to it knows "
        "inside and outside near it only");
  return open.count == 0;
}

}  // namespace migiwa
