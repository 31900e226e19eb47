#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "core/scene/sources.h"

namespace migiwa {

namespace {

using Corners = std::array<Vec3d, 3>;

/// Where the vertical line through a column of cells passes the surface.
struct Crossing {
  std::int64_t column;
  double height;  ///< (m)
  int turns;      ///< what the winding number changes by on the way up

  bool operator<(const Crossing& other) const {
    return column != other.column ? column < other.column : height < other.height;
  }
};

/// A triangle and the slabs of cells, of one z each, that it reaches into.
struct Reach {
  std::int64_t from, to;
  std::uint32_t triangle;
};

class Filling {
 public:
  /// The lattice is moved by so many cells, each in [0, 1), down from where it is centred on the mesh.
  /// Without `out` cells are only counted.
  Filling(const TriangleMesh& mesh, double spacing, const Vec3d& moved, std::vector<Vec3d>* out)
      : mesh_(mesh), spacing_(spacing), out_(out) {
    const Bounds bounds = mesh.bounds();
    const Eigen::Array3d cells = (bounds.size() / spacing).array().round();
    first_ = bounds.center() - spacing * (0.5 * (cells - 1).matrix() + moved);
    for (int axis = 0; axis < 3; ++axis)
      size_[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(cells[axis]) + (cells[axis] > 0 && moved[axis] > 0 ? 1 : 0);
  }

  /// Volume (m^3) by which that of the mesh, each part counted by itself, is beyond what is filled: where the
  /// winding number is beyond 1, less where it is below 0. After run().
  double countedAgain() const { return countedAgain_; }

  MeshFillWork run() {
    if (*std::min_element(size_.begin(), size_.end()) <= 0) return work_;
    const std::vector<Reach> reaches = slabsOfTriangles();
    std::vector<Reach> active;
    auto next = reaches.begin();
    for (std::int64_t k = reaches.empty() ? 0 : reaches.front().from;
         next != reaches.end() || !active.empty(); ++k) {
      if (active.empty()) k = next->from;
      for (; next != reaches.end() && next->from <= k; ++next) active.push_back(*next);
      std::erase_if(active, [k](const Reach& reach) { return reach.to < k; });
      crossings_.clear();
      for (const Reach& reach : active) cross(cornersOf(reach.triangle), k);
      fillSlab(k);
    }
    return work_;
  }

 private:
  Corners cornersOf(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {mesh_.vertices[a].cast<double>(), mesh_.vertices[b].cast<double>(),
            mesh_.vertices[c].cast<double>()};
  }

  /// The cells along an axis whose centres may lie between two coordinates, one more at each end.
  std::pair<std::int64_t, std::int64_t> cellsBetween(int axis, double low, double high) const {
    const auto last = static_cast<double>(size_[static_cast<std::size_t>(axis)] - 1);
    const double from = std::floor((low - first_[axis]) / spacing_),
                 to = std::ceil((high - first_[axis]) / spacing_);
    return {static_cast<std::int64_t>(std::clamp(from, 0.0, last + 1)),
            static_cast<std::int64_t>(std::clamp(to, -1.0, last))};
  }

  std::vector<Reach> slabsOfTriangles() const {
    std::vector<Reach> reaches;
    reaches.reserve(mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto [p, q, r] = cornersOf(t);
      const auto [low, high] = std::minmax({p.z(), q.z(), r.z()});
      const auto [from, to] = cellsBetween(2, low, high);
      if (from <= to) reaches.push_back({from, to, t});
    }
    std::stable_sort(reaches.begin(), reaches.end(),
                     [](const Reach& a, const Reach& b) { return a.from < b.from; });
    return reaches;
  }

  /// What of a triangle's shadow on the plane of x and z a line of constant z cuts out.
  static std::pair<double, double> cut(const Corners& corners, double z) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d &s = corners[k], &t = corners[(k + 1) % 3];
      const auto [least, most] = std::minmax({s.z(), t.z()});
      if (z < least || z > most) continue;
      const double part = most > least ? (z - s.z()) / (t.z() - s.z()) : 0;
      const double x = s.x() + part * (t.x() - s.x());
      low = std::min(low, x), high = std::max(high, x);
      if (most == least) low = std::min(low, t.x()), high = std::max(high, t.x());
    }
    return {low, high};
  }

  void cross(const Corners& corners, std::int64_t k) {
    // A line that runs exactly through an edge would count it twice or not at all: a shift that no mesh has
    // avoids that, and heights have one so that no centre lies between two faces that touch.
    const double shiftX = 1.2345e-7 * spacing_, shiftZ = 2.7183e-7 * spacing_;
    const double z = first_.z() + double(k) * spacing_ + shiftZ;
    const auto [low, high] = cut(corners, z);
    ++work_.lines;
    if (!(low <= high)) return;
    const auto& [p, q, r] = corners;
    const auto [from, to] = cellsBetween(0, low, high);
    for (std::int64_t i = from; i <= to; ++i) {
      ++work_.columns;
      const double x = first_.x() + double(i) * spacing_ + shiftX;
      const auto side = [&](const Vec3d& s, const Vec3d& t) {
        return (s.x() - x) * (t.z() - z) - (s.z() - z) * (t.x() - x);
      };
      const double u = side(q, r), v = side(r, p), w = side(p, q);
      const bool within = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
      if (!within || u + v + w == 0) continue;
      // A face that looks down is where the line comes in.
      const double twiceArea = u + v + w;
      crossings_.push_back({i, (u * p.y() + v * q.y() + w * r.y()) / twiceArea, twiceArea > 0 ? 1 : -1});
    }
  }

  double heightOf(std::int64_t j) const { return first_.y() + spacing_ * (double(j) + 3.1416e-7); }

  /// The lowest cell of a column whose centre is above a height.
  std::int64_t cellAbove(double height) const {
    const auto size = static_cast<double>(size_[1]);
    auto j = static_cast<std::int64_t>(std::clamp(std::floor((height - first_.y()) / spacing_), 0.0, size));
    while (j > 0 && heightOf(j - 1) > height) --j;
    while (j < size_[1] && heightOf(j) <= height) ++j;
    return j;
  }

  /// The mesh is where the winding number, the sum of the turns below, is 1 or more.
  void fillSlab(std::int64_t k) {
    std::sort(crossings_.begin(), crossings_.end());
    cells_.clear();
    int winding = 0;
    for (std::size_t c = 0; c + 1 < crossings_.size(); ++c) {
      const Crossing &below = crossings_[c], &above = crossings_[c + 1];
      winding += below.turns;
      if (below.column != above.column) {
        winding = 0;  // one that no other follows bounds nothing
        continue;
      }
      if (const int beyond = winding > 1 ? winding - 1 : std::min(winding, 0); beyond != 0)
        countedAgain_ += beyond * (above.height - below.height) * spacing_ * spacing_;
      if (winding < 1) continue;
      const std::int64_t end = cellAbove(above.height);
      const std::int64_t begin = cellAbove(below.height);
      work_.cells += std::max<std::int64_t>(end - begin, 0);
      for (std::int64_t j = begin; out_ != nullptr && j < end; ++j) cells_.emplace_back(j, below.column);
    }
    std::sort(cells_.begin(), cells_.end());
    for (const auto& [j, i] : cells_)
      out_->push_back(first_ + spacing_ * Vec3d(double(i), double(j), double(k)));
    work_.mostHeld = std::max(work_.mostHeld, crossings_.size() + cells_.size());
  }

  const TriangleMesh& mesh_;
  double spacing_;
  std::vector<Vec3d>* out_;
  Vec3d first_ = Vec3d::Zero();
  std::array<std::int64_t, 3> size_{};
  std::vector<Crossing> crossings_;                           ///< of one slab
  std::vector<std::pair<std::int64_t, std::int64_t>> cells_;  ///< of one slab: y, then x
  double countedAgain_ = 0;
  MeshFillWork work_;
};

/// Of the mesh, each part counted by itself (m^3).
double signedVolume(const TriangleMesh& mesh) {
  const Vec3d origin = mesh.bounds().center();
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d p = mesh.vertices[a].cast<double>() - origin, q = mesh.vertices[b].cast<double>() - origin,
                r = mesh.vertices[c].cast<double>() - origin;
    volume += p.dot(q.cross(r)) / 6;
  }
  return volume;
}

/// Moves of the lattice along each axis, in cells: none, and quarters.
std::vector<Vec3d> movesByLength() {
  constexpr std::array kMoves{0.0, 0.5, 0.25, 0.75};
  std::vector<Vec3d> moves;
  for (std::size_t sum = 1; sum <= 9; ++sum)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t k = 0; k < 4; ++k)
          if (i + j + k == sum) moves.emplace_back(kMoves[i], kMoves[j], kMoves[k]);
  return moves;
}

}  // namespace

MeshFillWork fillMesh(const TriangleMesh& mesh, double spacing, std::vector<Vec3d>& out) {
  if (mesh.triangles.empty()) return {};
  // Flat faces of a coarse lattice count for up to half a layer more or less; one of many cells has enough.
  constexpr double kWrong = 0.01, kRight = 0.005, kManyCells = 1e6;
  const std::size_t before = out.size();
  Filling centred(mesh, spacing, Vec3d::Zero(), &out);
  const MeshFillWork work = centred.run();
  const double cell = spacing * spacing * spacing, all = signedVolume(mesh);
  const auto error = [&](const MeshFillWork& filled, double volume) {
    return std::abs(static_cast<double>(filled.cells) * cell - volume) / volume;
  };
  double volume = all - centred.countedAgain();
  if (!(volume > 0) || error(work, volume) <= kWrong || static_cast<double>(work.cells) > kManyCells)
    return work;
  // Columns between those of the lattice tell more of what is there twice, which has flat faces, too.
  double again = 0;
  for (const double x : {0.25, 0.75})
    for (const double z : {0.25, 0.75}) {
      Filling between(mesh, spacing, {x, 0, z}, nullptr);
      between.run();
      again += between.countedAgain() / 4;
    }
  volume = all - again;
  if (!(volume > 0)) return work;
  double least = error(work, volume);
  Vec3d best = Vec3d::Zero();
  for (const Vec3d& moved : movesByLength()) {
    if (least <= kRight) break;
    const double other = error(Filling(mesh, spacing, moved, nullptr).run(), volume);
    if (other < least) least = other, best = moved;
  }
  if (best.isZero()) return work;
  out.resize(before);
  return Filling(mesh, spacing, best, &out).run();
}

}  // namespace migiwa
