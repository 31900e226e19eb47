#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
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
    while (own < sides.size() && sides[own].triangle != triangle) ++own;
    const std::size_t other = own ^ 1U;
    if (own >= sides.size() || other >= sides.size()) return std::nullopt;
    // Neighbours that face the same way run along their edge in opposite directions.
    return std::pair(sides[other].triangle, sides[own].forward != sides[other].forward);
  }

  struct Found {
    std::size_t count = 0;
    Vec3f middle = Vec3f::Zero();  ///< of one of them
  };
  /// Edges with one triangle only.
  Found open(const TriangleMesh& mesh) const {
    return count(mesh, [](std::size_t triangles) { return triangles == 1; });
  }
  /// Edges with more than two triangles that are no pairs: where sheets meet.
  Found odd(const TriangleMesh& mesh) const { return count(mesh, isOdd); }

  /// Makes an end of each sheet at the edges where an odd number of them meet, but of those that go on as
  /// one: sheets that end elsewhere, too, are taken off until the others are pairs. Where none ends
  /// elsewhere, as in a box with a wall across it, all do.
  void cutOdd(std::size_t triangles) {
    DisjointSets sheets(triangles);
    std::vector<bool> ends(triangles, false), taken(triangles, false);  // of a sheet's least triangle
    const auto join = [&](const std::vector<Side>& sides) {
      const std::uint32_t one = sheets.least(sides[0].triangle), other = sheets.least(sides[1].triangle);
      sheets.join(one, other);
      ends[std::min(one, other)] = ends[one] || ends[other];
    };
    std::vector<std::uint64_t> odd;
    for (const auto& [edge, sides] : sides_) {
      if (sides.size() == 2) join(sides);
      if (isOdd(sides.size())) odd.push_back(edge);
    }
    std::sort(odd.begin(), odd.end());
    for (const auto& [edge, sides] : sides_)
      if (sides.size() == 1) ends[sheets.least(sides[0].triangle)] = true;
    for (bool changed = true; changed;) {
      changed = false;
      for (const std::uint64_t edge : odd) {
        std::vector<Side>& sides = sides_[edge];
        if (std::erase_if(sides, [&](const Side& side) { return taken[sheets.least(side.triangle)]; }) > 0) {
          changed = true;
          if (sides.size() == 1) ends[sheets.least(sides[0].triangle)] = true;
          if (sides.size() == 2) join(sides);
        }
        if (!isOdd(sides.size())) continue;
        const auto ending = std::find_if(sides.begin(), sides.end(),
                                         [&](const Side& side) { return ends[sheets.least(side.triangle)]; });
        if (ending == sides.end()) continue;
        taken[sheets.least(ending->triangle)] = true;
        changed = true;
      }
    }
    for (const std::uint64_t edge : odd)
      if (isOdd(sides_[edge].size())) sides_[edge].clear();
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
      if (!counted(sides.size())) continue;
      if (found.count == 0 || edge < first) first = edge;
      ++found.count;
    }
    if (found.count > 0)
      found.middle = 0.5F * (mesh.vertices[first >> 32] + mesh.vertices[first & 0xFFFFFFFFU]);
    return found;
  }
  static bool isOdd(std::size_t triangles) { return triangles > 2 && triangles % 2 == 1; }
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
  }
  std::unordered_map<std::uint64_t, std::vector<Side>> sides_;
};

/// A connected part of the mesh: which triangles, and which of them face the other way than its first one.
struct Part {
  std::vector<std::uint32_t> triangles;
  std::vector<bool> turned;
  bool closed = true;
};

/// Appends the parts of the mesh. Returns a corner at which a surface has one side only, if there is one: it
/// is cut where it comes back to itself the other way round.
std::optional<std::uint32_t> findParts(const TriangleMesh& mesh, const Edges& edges,
                                       std::vector<Part>& parts) {
  enum : std::uint8_t { unknown, same, opposite };
  std::vector<std::uint8_t> state(mesh.triangles.size(), unknown);
  std::optional<std::uint32_t> oneSided;
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
        if (!neighbour) {
          part.closed = false;
          continue;
        }
        const auto [other, agree] = *neighbour;
        const std::uint8_t wanted = (state[triangle] == same) == agree ? same : opposite;
        if (state[other] == unknown) {
          state[other] = wanted;
          part.triangles.push_back(other);
        } else if (state[other] != wanted) {
          part.closed = false;
          if (!oneSided) oneSided = a;
        }
      }
    }
    for (const std::uint32_t triangle : part.triangles) part.turned.push_back(state[triangle] == opposite);
    parts.push_back(std::move(part));
  }
  return oneSided;
}

/// Sets `oneSided` to what findParts() returns.
std::vector<Part> connectedParts(const TriangleMesh& mesh, Edges& edges,
                                 std::optional<std::uint32_t>& oneSided) {
  std::vector<Part> parts;
  oneSided = findParts(mesh, edges, parts);
  if (oneSided && edges.crowded()) {
    parts.clear();
    edges.pairByDirection();
    oneSided = findParts(mesh, edges, parts);
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
std::vector<std::size_t> outermost(const TriangleMesh& mesh, std::span<const Part> parts) {
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

/// Whether the part lies in a hollow: in another part that faces inwards once it is turned.
bool inHollow(const TriangleMesh& mesh, std::span<const Part> parts, const std::vector<bool>& flips,
              std::size_t part) {
  for (std::size_t other = 0; other < parts.size() && parts.size() <= kMostNestedParts; ++other)
    if (other != part && (signedVolume(mesh, parts[other]) < 0) != flips[other] &&
        liesWithin(mesh, parts[part], parts[other]))
      return true;
  return false;
}

/// Which closed parts have to be turned for the outermost ones to face outwards. Those within them
/// keep how they face relative to them: inwards is the wall of a hollow.
std::vector<bool> turnsOfClosed(const TriangleMesh& mesh, std::span<const Part> parts,
                                const std::vector<bool>& byMost, std::vector<std::string>& notes) {
  const std::vector<std::size_t> around = outermost(mesh, parts);
  std::vector<bool> flips;
  std::vector<std::size_t> outwards;  // of those within others
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::size_t outer = around[k];
    const bool flip = signedVolume(mesh, parts[outer]) < 0;
    const bool inverted = flip != byMost[outer];
    flips.push_back(outer == k ? flip : byMost[k] != inverted);
    if (outer != k && (signedVolume(mesh, parts[k]) < 0) == flips[k]) outwards.push_back(k);
  }
  const auto needless = static_cast<std::size_t>(std::count_if(
      outwards.begin(), outwards.end(), [&](std::size_t k) { return !inHollow(mesh, parts, flips, k); }));
  if (needless > 0)
    notes.push_back(counted(needless, "part lies", "parts lie") +
                    " within others and face outwards as those do, which changes nothing: for a hollow, turn "
                    "their triangles round");
  return flips;
}

/// Turns the triangles of parts that have to be turned. Returns how many they are.
std::size_t turn(TriangleMesh& mesh, std::span<const Part> parts, const std::vector<bool>& flips) {
  std::size_t turned = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (std::size_t t = 0; t < parts[k].triangles.size(); ++t) {
      if (parts[k].turned[t] == flips[k]) continue;
      Triangle& triangle = mesh.triangles[parts[k].triangles[t]];
      std::swap(triangle[1], triangle[2]);
      ++turned;
    }
  }
  return turned;
}

void orient(TriangleMesh& mesh, std::span<const Part> closed, std::span<const Part> open,
            std::vector<std::string>& notes) {
  const auto byMost = [](std::span<const Part> parts) {
    std::vector<bool> flips;
    for (const Part& part : parts) {
      const auto opposed = static_cast<std::size_t>(std::count(part.turned.begin(), part.turned.end(), true));
      flips.push_back(2 * opposed > part.turned.size());
    }
    return flips;
  };
  const auto note = [&](std::size_t turned, const char* how) {
    if (turned == 0) return;
    std::string text = counted(turned, "triangle was", "triangles were");
    notes.push_back(text.append(" turned to face ").append(how));
  };
  note(turn(mesh, closed, turnsOfClosed(mesh, closed, byMost(closed), notes)), "outwards as the others do");
  note(turn(mesh, open, byMost(open)), "the same way as their neighbours");
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

/// Gives each part corners of its own.
void separate(TriangleMesh& mesh, const std::vector<Part>& parts) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  // The part that a corner was last met in, and its number there.
  std::vector<std::uint32_t> met(mesh.vertices.size(), kNone), own(mesh.vertices.size());
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    for (const std::uint32_t triangle : parts[part].triangles) {
      for (std::uint32_t& corner : mesh.triangles[triangle]) {
        const std::uint32_t shared = corner;
        if (met[shared] != part) {
          own[shared] = met[shared] == kNone ? shared : static_cast<std::uint32_t>(mesh.vertices.size());
          const Vec3f place = mesh.vertices[shared];
          if (met[shared] != kNone) mesh.vertices.push_back(place);
          met[shared] = part;
        }
        corner = own[shared];
      }
    }
  }
}

}  // namespace

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

RepairedMesh repairMesh(TriangleMesh& mesh, const std::string& place, std::vector<std::string>& notes) {
  weldMesh(mesh, notes);
  std::vector<Triangle> all = std::move(mesh.triangles);
  mesh.triangles = withoutRepeated(all);
  if (mesh.triangles.empty()) throw InputError(place, "expected triangles with an area, found none");
  RepairedMesh result;
  Edges edges(mesh);
  Edges::Found odd = edges.odd(mesh);
  bool shared = false;
  if (odd.count > 0) {
    // Parts that touch have triangles with the same corners, one of each.
    std::swap(mesh.triangles, all);
    const Edges touching(mesh);
    shared = touching.odd(mesh).count == 0;
    if (shared) {
      edges = touching;
      odd = {};
    } else {
      std::swap(mesh.triangles, all);
    }
  }
  if (!shared) noteRepeated(all.size() - mesh.triangles.size(), notes);
  if (odd.count > 0) {
    edges.cutOdd(mesh.triangles.size());
    result.branching = {place,
                        "expected edges of two triangles, or of two for each part that touches there (a "
                        "manifold), found " +
                            counted(odd.count, "edge", "edges") + " of three or more, the first at " +
                            at(odd.middle) + "; a wall of shape \"mesh\" takes them as sheets that meet"};
    notes.push_back("sheets meet at " + counted(odd.count, "edge", "edges") +
                    " of three or more triangles, the first at " + at(odd.middle));
  }
  std::optional<std::uint32_t> oneSided;
  std::vector<Part> parts = connectedParts(mesh, edges, oneSided);
  if (oneSided) {
    const std::string where = "like a Moebius strip at " + at(mesh.vertices[*oneSided]);
    if (!result.branching)
      result.branching = {place, "expected a surface with two sides, found one " + where +
                                     "; a wall of shape \"mesh\" takes it as a sheet"};
    notes.push_back("the mesh has one side only, " + where + "; as a wall it is a sheet");
  }
  const auto open =
      std::stable_partition(parts.begin(), parts.end(), [](const Part& part) { return part.closed; });
  orient(mesh, {parts.begin(), open}, {open, parts.end()}, notes);
  if (shared) dropShared(mesh, notes);
  if (odd.count > 0) separate(mesh, parts);
  result.closed = open == parts.end();
  if (const Edges::Found rim = edges.open(mesh); rim.count > 0) {
    result.rim = counted(rim.count, "edge has", "edges have") +
                 " a triangle on one side only, the first near " + at(rim.middle);
    notes.push_back(
        "the mesh is open: " + result.rim +
        "; its triangles as a wall end there and have fluid on both sides, a SLIM surface fitted to it knows "
        "inside and outside near it only");
  }
  return result;
}

}  // namespace migiwa
