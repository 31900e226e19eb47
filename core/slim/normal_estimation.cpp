#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <queue>
#include <sstream>
#include <tuple>

#include <Eigen/Eigenvalues>

#include "core/base/messages.h"
#include "core/slim/points.h"
#include "core/slim/shape_import.h"

namespace migiwa {

namespace {

/// Neighbours that a plane goes through, and that orientation is propagated to.
constexpr std::size_t kNeighbours = 16;
/// Mean normal of a surface, up to which it counts as closed.
constexpr double kMostUncovered = 0.1;
/// Points at which inside and outside are checked, and the part of them that may be wrong: at sharp edges.
constexpr std::size_t kChecked = 200;
constexpr double kMostWrong = 0.03;
/// Parts beyond this many are noise, not a shape.
constexpr std::size_t kMostParts = 100;

class Cloud {
 public:
  explicit Cloud(const std::vector<OrientedPoint>& points) : levels_(points) {
    const auto all = levels_.points();
    points_.assign(all.begin(), all.end());
    neighbours_.resize(points_.size());
    areas_.resize(points_.size());
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = 0; k < points_.size(); ++k) {
      const Vec3f& p = points_[k].position;
      float reach = 3 * levels_.spacing();
      const std::size_t wanted = std::min(kNeighbours + 1, points_.size());
      for (levels_.withinAll(p, reach, near); near.size() < wanted; levels_.withinAll(p, reach, near))
        reach *= 1.5F;
      const auto closer = [&](std::uint32_t a, std::uint32_t b) {
        const float da = (points_[a].position - p).squaredNorm(),
                    db = (points_[b].position - p).squaredNorm();
        return da != db ? da < db : a < b;
      };
      std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(wanted), near.end(), closer);
      near.resize(wanted);
      const double radius = static_cast<double>((points_[near.back()].position - p).norm());
      areas_[k] = std::numbers::pi * radius * radius / static_cast<double>(wanted);
      neighbours_[k] = near;
    }
  }

  void fitPlanes() {
    for (std::uint32_t k = 0; k < points_.size(); ++k) {
      Vec3d mean = Vec3d::Zero();
      for (const std::uint32_t other : neighbours_[k]) mean += points_[other].position.cast<double>();
      mean /= static_cast<double>(neighbours_[k].size());
      Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
      for (const std::uint32_t other : neighbours_[k]) {
        const Vec3d q = points_[other].position.cast<double>() - mean;
        spread += q * q.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
      points_[k].normal = solver.eigenvectors().col(0).cast<float>().normalized();
    }
  }

  /// Hands the side of one point on to its neighbours, over the edges across which normals turn least first
  /// (Prim), part by part; then turns each part outwards, and those that are walls of hollows inwards.
  void agree() {
    std::vector<std::uint32_t> parts(points_.size(), kNone);
    std::vector<std::vector<std::uint32_t>> links = neighbours_;
    for (std::uint32_t k = 0; k < points_.size(); ++k)
      for (const std::uint32_t other : neighbours_[k]) links[other].push_back(k);
    std::vector<std::vector<std::uint32_t>> members;
    for (std::uint32_t start = 0; start < points_.size(); ++start) {
      if (parts[start] != kNone) continue;
      const auto part = static_cast<std::uint32_t>(members.size());
      members.emplace_back();
      using Edge = std::tuple<float, std::uint32_t, std::uint32_t>;  // how much it turns, to, from
      std::priority_queue<Edge, std::vector<Edge>, std::greater<>> open;
      open.emplace(0.0F, start, start);
      while (!open.empty()) {
        const auto [turn, at, from] = open.top();
        open.pop();
        if (parts[at] != kNone) continue;
        parts[at] = part;
        members[part].push_back(at);
        if (points_[at].normal.dot(points_[from].normal) < 0) points_[at].normal = -points_[at].normal;
        for (const std::uint32_t next : links[at])
          if (parts[next] == kNone)
            open.emplace(1 - std::abs(points_[at].normal.dot(points_[next].normal)), next, at);
      }
    }
    if (members.size() > kMostParts) return;
    for (const auto& part : members)
      if (flux(part) < 0) turn(part);
    std::vector<std::uint8_t> hollow(members.size(), 0);
    for (std::size_t k = 0; k < members.size(); ++k) {
      int depth = 0;
      for (std::size_t other = 0; other < members.size(); ++other)
        if (other != k && winding(members[other], points_[members[k][0]].position.cast<double>()) > 0.5)
          ++depth;
      hollow[k] = depth % 2 == 1 ? 1 : 0;
    }
    for (std::size_t k = 0; k < members.size(); ++k)
      if (hollow[k] != 0) turn(members[k]);
  }

  /// What is wrong with the sides of the normals, or nothing: on a closed surface whose normals face
  /// outwards, the solid angle that it fills is none just outside and all just inside (the winding number).
  std::string fault() const {
    Vec3d mean = Vec3d::Zero();
    double area = 0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      mean += areas_[k] * points_[k].normal.cast<double>();
      area += areas_[k];
    }
    if (mean.norm() > kMostUncovered * area) return "they do not cover a closed surface all around";
    std::vector<std::uint32_t> all(points_.size());
    std::iota(all.begin(), all.end(), 0U);
    const std::size_t checked = std::min(kChecked, points_.size());
    std::size_t wrong = 0;
    Vec3f first = Vec3f::Zero();
    for (std::size_t k = 0; k < checked; ++k) {  // in random order
      const Vec3d p = points_[k].position.cast<double>(), n = points_[k].normal.cast<double>();
      const double step = 2 * std::sqrt(areas_[k]);
      if (winding(all, p + step * n) < 0.5 && winding(all, p - step * n) > 0.5) continue;
      if (wrong++ == 0) first = points_[k].position;
    }
    if (static_cast<double>(wrong) <= kMostWrong * static_cast<double>(checked)) return {};
    std::ostringstream text;
    text << "its sheets are too close, or its points too far apart, near (" << first.x() << ", " << first.y()
         << ", " << first.z() << ")";
    return text.str();
  }

  const std::vector<OrientedPoint>& points() const { return points_; }
  /// How many normals face another way than those that the cloud was made with.
  std::size_t turned() const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (points_[k].normal.dot(levels_.points()[k].normal) < 0) ++count;
    return count;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  void turn(const std::vector<std::uint32_t>& part) {
    for (const std::uint32_t k : part) points_[k].normal = -points_[k].normal;
  }
  /// Three times the volume that the part encloses, negative if its normals face inwards.
  double flux(const std::vector<std::uint32_t>& part) const {
    Vec3d middle = Vec3d::Zero();
    for (const std::uint32_t k : part)
      middle += points_[k].position.cast<double>() / static_cast<double>(part.size());
    double sum = 0;
    for (const std::uint32_t k : part)
      sum += areas_[k] * points_[k].normal.cast<double>().dot(points_[k].position.cast<double>() - middle);
    return sum;
  }
  /// Part of the solid angle about p that the part fills: 1 inside a closed one, 0 outside.
  double winding(const std::vector<std::uint32_t>& part, const Vec3d& p) const {
    double sum = 0;
    for (const std::uint32_t k : part) {
      const Vec3d q = points_[k].position.cast<double>() - p;
      const double squared = std::max(q.squaredNorm(), 1e-3 * areas_[k]);
      sum += areas_[k] * points_[k].normal.cast<double>().dot(q) / (squared * std::sqrt(squared));
    }
    return sum / (4 * std::numbers::pi);
  }

  PointLevels levels_;
  std::vector<OrientedPoint> points_;
  std::vector<std::vector<std::uint32_t>> neighbours_;  ///< nearest first, the point itself included
  std::vector<double> areas_;                           ///< of the surface, that each point stands for (m^2)
};

}  // namespace

void estimateNormals(std::vector<OrientedPoint>& points, const std::string& place) {
  Cloud cloud(points);
  cloud.fitPlanes();
  cloud.agree();
  if (const std::string fault = cloud.fault(); !fault.empty())
    throw InputError(place,
                     "expected points with normals, or points all over the surface of a solid, found points "
                     "without normals whose inside and outside cannot be told apart: " +
                         fault);
  points = cloud.points();
}

std::size_t orientNormals(std::vector<OrientedPoint>& points) {
  Cloud cloud(points);
  if (cloud.fault().empty()) return 0;
  cloud.agree();
  if (!cloud.fault().empty()) return 0;
  points = cloud.points();
  return cloud.turned();
}

}  // namespace migiwa
