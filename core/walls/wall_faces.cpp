#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include <Eigen/Geometry>

#include "core/base/messages.h"
#include "core/walls/triangles.h"

namespace migiwa {

namespace {

/// Of the mesh's size: what is nearer than that touches.
constexpr double kTouching = 1e-6;
/// Pieces that a wall has at most.
constexpr std::size_t kMostPieces = 4000000;

using Corners = std::array<Vec3d, 3>;
/// A convex piece of a face.
using Polygon = std::vector<Vec3d>;

struct Plane {
  Vec3d normal;
  double offset;
  double at(const Vec3d& p) const { return normal.dot(p) - offset; }
};

/// A face that meets another: what it cuts the other's plane along.
struct Cut {
  Plane plane;
  Vec3d from, to;  ///< the part of that plane that it cuts
};

/// The same for both directions; the smaller corner is in the upper half.
std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

/// Which faces belong to parts of the mesh that have a rim: an edge that as many faces run along in one
/// direction as in the other is none.
std::vector<bool> openFaces(const TriangleMesh& mesh) {
  DisjointSets parts(mesh.vertices.size());
  std::unordered_map<std::uint64_t, int> balance;
  for (const auto& corners : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      balance[edgeKey(a, b)] += a < b ? 1 : -1;
      parts.join(a, b);
    }
  }
  std::vector<bool> open(mesh.vertices.size(), false), result(mesh.triangles.size());
  for (const auto& [edge, surplus] : balance)
    if (surplus != 0) open[parts.least(static_cast<std::uint32_t>(edge >> 32))] = true;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = open[parts.least(mesh.triangles[k][0])];
  return result;
}

class FaceSplitter {
 public:
  FaceSplitter(const TriangleMesh& mesh, bool fluidInside, const std::string& place)
      : mesh_(mesh),
        fluidInside_(fluidInside),
        place_(place),
        open_(openFaces(mesh)),
        allOpen_(std::find(open_.begin(), open_.end(), false) == open_.end()),
        tree_(trianglesOf(mesh)) {
    const Bounds bounds = mesh.bounds();
    touching_ = kTouching * bounds.size().maxCoeff();
    for (const auto& corners : mesh.triangles) {
      faces_.push_back({corner(corners[0]), corner(corners[1]), corner(corners[2])});
      const Corners& t = faces_.back();
      const Vec3d across = (t[1] - t[0]).cross(t[2] - t[0]);
      const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
      // One that is no wider than what touches has no side, and no normal that means anything.
      const bool wide = across.norm() > touching_ * longest;
      const Vec3d normal = wide ? across.normalized() : Vec3d(Vec3d::Zero());
      planes_.push_back({normal, normal.dot(t[0])});
    }
  }

  std::vector<WallTriangle> split() {
    std::vector<std::uint32_t> plain;  // faces that no other meets
    for (std::uint32_t k = 0; k < faces_.size(); ++k) {
      if (planes_[k].normal.isZero()) continue;
      const Meetings met = meetings(k);
      if (!met.any) {
        plain.push_back(k);
        continue;
      }
      std::vector<Polygon> pieces{Polygon(faces_[k].begin(), faces_[k].end())};
      for (const Cut& cut : met.cuts) splitBy(cut, pieces);
      for (const Polygon& piece : pieces) {
        const Vec3d middle = std::accumulate(piece.begin(), piece.end(), Vec3d(Vec3d::Zero())) /
                             static_cast<double>(piece.size());
        // Of faces that lie on each other, one counts.
        if (std::any_of(met.coplanar.begin(), met.coplanar.end(),
                        [&](std::uint32_t other) { return other < k && covers(other, middle); }))
          continue;
        add(k, piece, sideOf(k, middle));
      }
    }
    addPlain(plain);
    return std::move(result_);
  }

 private:
  enum class Side { none, outwards, inwards, sheet };

  Vec3d corner(std::uint32_t vertex) const { return mesh_.vertices[vertex].cast<double>(); }

  static std::vector<WallTriangle> trianglesOf(const TriangleMesh& mesh) {
    std::vector<WallTriangle> triangles;
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
      const auto& [a, b, c] = mesh.triangles[k];
      triangles.push_back({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, Vec3f::Zero(), false, k});
    }
    return triangles;
  }

  /// How other faces meet one, but those that share an edge with it and go on from there.
  struct Meetings {
    bool any = false;
    std::vector<Cut> cuts;                ///< through it
    std::vector<std::uint32_t> coplanar;  ///< that lie on it
  };

  Meetings meetings(std::uint32_t k) const {
    const Corners& own = faces_[k];
    const Vec3f slack = Vec3f::Constant(static_cast<float>(2 * touching_));
    const Vec3f low = own[0].cwiseMin(own[1]).cwiseMin(own[2]).cast<float>() - slack,
                high = own[0].cwiseMax(own[1]).cwiseMax(own[2]).cast<float>() + slack;
    Meetings met;
    tree_.visitBox(low, high, [&](std::uint32_t at) {
      const std::uint32_t other = tree_.triangles()[at].face;
      if (other != k && !planes_[other].normal.isZero()) meet(k, other, met);
    });
    return met;
  }

  void meet(std::uint32_t k, std::uint32_t other, Meetings& met) const {
    const Corners& theirs = faces_[other];
    std::array<double, 3> heights{};
    for (std::size_t c = 0; c < 3; ++c) heights[c] = planes_[k].at(theirs[c]);
    const auto [low, high] = std::minmax({heights[0], heights[1], heights[2]});
    if (low > touching_ || high < -touching_) return;
    if (low >= -touching_ && high <= touching_) {
      if (!overlap(k, other)) return;
      met.any = true;
      met.coplanar.push_back(other);
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d &a = theirs[c], &b = theirs[(c + 1) % 3];
        const Vec3d across = (b - a).cross(planes_[k].normal).normalized();
        addCut(k, {{across, across.dot(a)}, a, b}, met);
      }
      return;
    }
    // The part of the plane that the other face passes through, from where it comes within touching distance.
    Polygon ends;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t d = (c + 1) % 3;
      if (std::abs(heights[c]) <= touching_) {
        ends.push_back(theirs[c]);
      } else if (std::abs(heights[d]) > touching_ && (heights[c] > 0) != (heights[d] > 0)) {
        ends.push_back(theirs[c] + heights[c] / (heights[c] - heights[d]) * (theirs[d] - theirs[c]));
      }
    }
    if (ends.size() != 2) return;
    addCut(k, {planes_[other], ends[0], ends[1]}, met);
    // One that runs along an edge from elsewhere parts the faces on both sides of it.
    if ((ends[1] - ends[0]).norm() > touching_ && !shareEdge(k, other)) met.any = true;
  }

  bool shareEdge(std::uint32_t one, std::uint32_t other) const {
    const auto &t = mesh_.triangles[one], &s = mesh_.triangles[other];
    return std::count_if(t.begin(), t.end(),
                         [&](std::uint32_t v) { return std::find(s.begin(), s.end(), v) != s.end(); }) >= 2;
  }

  void addCut(std::uint32_t k, const Cut& cut, Meetings& met) const {
    if (!runsThrough(cut, Polygon(faces_[k].begin(), faces_[k].end()), planes_[k].normal)) return;
    met.any = true;
    met.cuts.push_back(cut);
  }

  /// Whether more than a point of the cut lies in the inner of a polygon with this normal.
  bool runsThrough(const Cut& cut, const Polygon& polygon, const Vec3d& normal) const {
    double enter = 0, leave = 1;
    const double length = (cut.to - cut.from).norm();
    if (length <= touching_) return false;
    for (std::size_t c = 0; c < polygon.size(); ++c) {
      const Vec3d &a = polygon[c], &b = polygon[(c + 1) % polygon.size()];
      const Vec3d inwards = normal.cross(b - a).normalized();
      const double from = inwards.dot(cut.from - a) - touching_, to = inwards.dot(cut.to - a) - touching_;
      if (from <= 0 && to <= 0) return false;
      if (from <= 0) enter = std::max(enter, from / (from - to));
      if (to <= 0) leave = std::min(leave, from / (from - to));
    }
    return (leave - enter) * length > touching_;
  }

  void splitBy(const Cut& cut, std::vector<Polygon>& pieces) const {
    std::vector<Polygon> next;
    for (Polygon& piece : pieces) {
      const Vec3d normal = (piece[1] - piece[0]).cross(piece[2] - piece[0]).normalized();
      Polygon above, below;
      if (runsThrough(cut, piece, normal)) {
        for (std::size_t c = 0; c < piece.size(); ++c) {
          const Vec3d &a = piece[c], &b = piece[(c + 1) % piece.size()];
          const double from = cut.plane.at(a), to = cut.plane.at(b);
          if (from >= 0) above.push_back(a);
          if (from <= 0) below.push_back(a);
          if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
            const Vec3d between = a + from / (from - to) * (b - a);
            above.push_back(between);
            below.push_back(between);
          }
        }
      }
      if (above.size() >= 3 && below.size() >= 3) {
        next.push_back(std::move(above));
        next.push_back(std::move(below));
      } else {
        next.push_back(std::move(piece));
      }
    }
    pieces = std::move(next);
  }

  bool covers(std::uint32_t k, const Vec3d& p) const {
    const Corners& t = faces_[k];
    for (std::size_t c = 0; c < 3; ++c)
      if (planes_[k].normal.cross(t[(c + 1) % 3] - t[c]).dot(p - t[c]) < 0) return false;
    return true;
  }

  /// Whether two faces in one plane share an area: no edge of either keeps them apart.
  bool overlap(std::uint32_t one, std::uint32_t other) const {
    const auto apart = [&](std::uint32_t k, std::uint32_t l) {
      const Corners &t = faces_[k], &s = faces_[l];
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d inwards = planes_[k].normal.cross(t[(c + 1) % 3] - t[c]).normalized();
        double farthest = -1;
        for (const Vec3d& p : s) farthest = std::max(farthest, inwards.dot(p - t[c]));
        if (farthest <= touching_) return true;
      }
      return false;
    };
    return !apart(one, other) && !apart(other, one);
  }

  /// How often the closed parts wind about p: faces that a ray crosses outwards, less those inwards.
  int winding(const Vec3d& p) const {
    // Directions that no modeller would choose; the next where a ray comes too near to an edge.
    RandomSequence random(7);
    const double far = 3 * (mesh_.bounds().size().norm() + (p - mesh_.bounds().center()).norm());
    int crossings = 0;
    for (int attempt = 0; attempt < 16; ++attempt) {
      Vec3d direction(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
      direction.normalize();
      crossings = 0;
      bool clear = true;
      tree_.visitWay(p.cast<float>(), (p + far * direction).cast<float>(), [&](std::uint32_t at) {
        const std::uint32_t k = tree_.triangles()[at].face;
        if (open_[k] || planes_[k].normal.isZero()) return;
        clear = cross(k, p, direction, crossings) && clear;
      });
      if (clear) break;
    }
    return crossings;
  }

  /// Counts the crossing of a ray with a face. False where it is too near to an edge to be sure.
  bool cross(std::uint32_t k, const Vec3d& p, const Vec3d& direction, int& crossings) const {
    const Vec3d a = faces_[k][0] - p, b = faces_[k][1] - p, c = faces_[k][2] - p;
    const double u = direction.dot(b.cross(c)), v = direction.dot(c.cross(a)), w = direction.dot(a.cross(b));
    const double nearEdge = 1e-12 * std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
    const double least = std::min({u, v, w}), most = std::max({u, v, w});
    if (least < -nearEdge && most > nearEdge) return true;
    const double sum = u + v + w;
    if (sum == 0) return std::abs(planes_[k].at(p)) > 0;
    if ((u * a + v * b + w * c).dot(direction) / sum < 0) return true;
    crossings += sum > 0 ? 1 : -1;
    return std::min({std::abs(u), std::abs(v), std::abs(w)}) > nearEdge;
  }

  Side sideOf(std::uint32_t k, const Vec3d& middle) const {
    const Vec3d step = 4 * touching_ * planes_[k].normal;
    const bool before = winding(middle + step) >= 1, behind = winding(middle - step) >= 1;
    // Of sheets alone none encloses anything: all of them are wet.
    if (open_[k]) return before == behind && (before == fluidInside_ || allOpen_) ? Side::sheet : Side::none;
    if (before == behind) return Side::none;
    return behind ? Side::outwards : Side::inwards;
  }

  /// Faces that share an edge and that nothing else meets have the same on their sides.
  void addPlain(const std::vector<std::uint32_t>& plain) {
    DisjointSets groups(faces_.size());
    struct Neighbours {
      int faces = 0;
      std::uint32_t first = 0, second = 0;
    };
    std::unordered_map<std::uint64_t, Neighbours> edges;
    std::vector<bool> isPlain(faces_.size(), false);
    for (const std::uint32_t k : plain) isPlain[k] = true;
    for (std::uint32_t k = 0; k < faces_.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t a = mesh_.triangles[k][c], b = mesh_.triangles[k][(c + 1) % 3];
        Neighbours& edge = edges[edgeKey(a, b)];
        (edge.faces++ == 0 ? edge.first : edge.second) = k;
      }
    }
    for (const auto& [key, edge] : edges)
      if (edge.faces == 2 && isPlain[edge.first] && isPlain[edge.second])
        groups.join(edge.first, edge.second);
    std::unordered_map<std::uint32_t, Side> sides;
    for (const std::uint32_t k : plain) {
      const auto [known, isNew] = sides.try_emplace(groups.least(k), Side::none);
      if (isNew) known->second = sideOf(k, (faces_[k][0] + faces_[k][1] + faces_[k][2]) / 3);
      add(k, Polygon(faces_[k].begin(), faces_[k].end()), known->second);
    }
  }

  void add(std::uint32_t k, const Polygon& piece, Side side) {
    if (side == Side::none) return;
    if (result_.size() + piece.size() > kMostPieces)
      throw InputError(place_, "expected parts that cross in fewer places, found more than " +
                                   std::to_string(kMostPieces) +
                                   " pieces of faces; join the parts in a mesh program first");
    const bool turned = (side == Side::inwards) != fluidInside_ && side != Side::sheet;
    Vec3f normal = planes_[k].normal.cast<float>();
    if (turned) normal = -normal;
    for (std::size_t c = 1; c + 1 < piece.size(); ++c) {
      WallTriangle triangle{{piece[0].cast<float>(), piece[c].cast<float>(), piece[c + 1].cast<float>()},
                            normal,
                            side == Side::sheet,
                            k};
      // What rounding to float leaves no width of cannot be told from its border.
      const Vec3f along = triangle.corners[1] - triangle.corners[0];
      if (along.cross(triangle.corners[2] - triangle.corners[0]).isZero(0)) continue;
      if (turned) std::swap(triangle.corners[1], triangle.corners[2]);
      result_.push_back(triangle);
    }
  }

  const TriangleMesh& mesh_;
  bool fluidInside_;
  const std::string& place_;
  std::vector<bool> open_;
  bool allOpen_;
  TriangleTree tree_;  ///< over the mesh's faces
  double touching_ = 0;
  std::vector<Corners> faces_;
  std::vector<Plane> planes_;
  std::vector<WallTriangle> result_;
};

}  // namespace

std::vector<WallTriangle> wallFaces(const TriangleMesh& mesh, bool fluidInside, const std::string& place) {
  return FaceSplitter(mesh, fluidInside, place).split();
}

}  // namespace migiwa
