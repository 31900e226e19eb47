#include "core/slim/slim_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/slim/distance_grid.h"

namespace migiwa {

namespace {

constexpr std::uint32_t kLeaf = 8;
/// Foot points are looked for on the blended surface up to this many cells of the coarse grid from it.
constexpr float kNearCells = 6;
/// Part of a ball whose polynomial is sampled for the coarse grid: a little more than its core.
constexpr float kSampledReach = 1.1F * kSlimCore;

}  // namespace

SlimModel::SlimModel(std::vector<SlimNode> nodes, int degree, bool closed, ThreadPool& pool)
    : nodes_(std::move(nodes)), degree_(degree), closed_(closed) {
  tree_.reserve(2 * nodes_.size() / (kLeaf / 2) + 2);
  if (!nodes_.empty()) buildTree(0, static_cast<std::uint32_t>(nodes_.size()));
  for (const SlimNode& node : nodes_) {
    bounds_.include(node.centre.cast<double>());
    largestRadius_ = std::max(largestRadius_, node.radius);
  }
  buildCells();
  buildDistances(pool);
}

SlimModel::~SlimModel() = default;

std::uint32_t SlimModel::buildTree(std::uint32_t begin, std::uint32_t end) {
  Vec3f low = Vec3f::Constant(std::numeric_limits<float>::infinity()), high = -low, lowest = low,
        highest = high;
  for (std::uint32_t k = begin; k < end; ++k) {
    const SlimNode& node = nodes_[k];
    low = low.cwiseMin((node.centre.array() - node.radius).matrix());
    high = high.cwiseMax((node.centre.array() + node.radius).matrix());
    lowest = lowest.cwiseMin(node.centre), highest = highest.cwiseMax(node.centre);
  }
  const auto at = static_cast<std::uint32_t>(tree_.size());
  tree_.push_back({low, high, begin, end, 0});
  if (end - begin <= kLeaf) return at;
  int axis = 0;
  (highest - lowest).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(nodes_.begin() + begin, nodes_.begin() + middle, nodes_.begin() + end,
                   [axis](const SlimNode& a, const SlimNode& b) { return a.centre[axis] < b.centre[axis]; });
  buildTree(begin, middle);
  const std::uint32_t right = buildTree(middle, end);
  tree_[at].right = right;
  return at;
}

void SlimModel::buildCells() {
  if (nodes_.empty()) return;
  std::vector<float> radii;
  for (const SlimNode& node : nodes_) radii.push_back(node.radius);
  std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2), radii.end());
  // As large as most balls; a few very large ones must not fill millions of cells, nor may coordinates leave
  // the range of a key.
  const auto extent = static_cast<float>(bounds_.size().maxCoeff());
  const float cell = std::max({radii[radii.size() / 2], largestRadius_ / 12, extent * 4e-6F});
  inverseCell_ = 1 / cell;
  struct Entry {
    std::uint64_t key;
    std::uint32_t node;
  };
  std::vector<Entry> entries;
  for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
    const SlimNode& node = nodes_[k];
    // Whole numbers: far from the origin a float does not count one by one.
    const auto cellsOf = [&](const Eigen::Array3f& p) {
      const Eigen::Array3f place = p * inverseCell_;
      return CellCoordinates{cellAlong(place.x()), cellAlong(place.y()), cellAlong(place.z())};
    };
    const CellCoordinates from = cellsOf(node.centre.array() - node.radius),
                          to = cellsOf(node.centre.array() + node.radius);
    for (std::int32_t z = from.z; z <= to.z; ++z) {
      for (std::int32_t y = from.y; y <= to.y; ++y) {
        for (std::int32_t x = from.x; x <= to.x; ++x) {
          const Eigen::Array3f corner(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
          const Vec3f low = (corner * cell).matrix(), high = ((corner + 1) * cell).matrix();
          if ((node.centre.cwiseMax(low).cwiseMin(high) - node.centre).squaredNorm() >=
              node.radius * node.radius)
            continue;
          entries.push_back({cellKey({x, y, z}), k});
        }
      }
    }
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.node < b.node; });
  std::vector<std::uint64_t> keys;
  keys.reserve(entries.size());
  cellNodes_.reserve(entries.size());
  for (const Entry& entry : entries) {
    keys.push_back(entry.key);
    cellNodes_.push_back(entry.node);
  }
  cells_.build(keys);

  for (const SlimNode& node : nodes_) {
    const Vec3f &c = node.centre, &n = node.normal, &t = node.tangent, b = node.bitangent();
    const auto& k = node.coefficients;
    const float inverseSquare = 1 / (node.radius * node.radius);
    if (degree_ == 1) {
      planes_.push_back({c.x(), c.y(), c.z(), inverseSquare, n.x(), n.y(), n.z(), k[0]});
    } else {
      packed_.push_back({c.x(), c.y(), c.z(), inverseSquare, n.x(), n.y(), n.z(), k[0],
                         t.x(), t.y(), t.z(), k[1],          b.x(), b.y(), b.z(), k[2],
                         k[3],  k[4],  k[5],  k[6],          k[7],  k[8],  k[9],  0});
    }
  }
}

template <int Degree>
SlimModel::Value SlimModel::evaluateDegree(const Vec3f& p) const {
  const CellHash::Range range = cells_.find(cellKey(
      {cellAlong(p.x() * inverseCell_), cellAlong(p.y() * inverseCell_), cellAlong(p.z() * inverseCell_)}));
  // f = sum w f_i / sum w, so grad f = (sum w grad f_i + sum (f_i - f) grad w) / sum w, with grad w along the
  // offsets from the centres.
  float weights = 0, values = 0;
  float gx = 0, gy = 0, gz = 0;  // sum w grad f_i
  float sx = 0, sy = 0, sz = 0;  // sum grad w
  float fx = 0, fy = 0, fz = 0;  // sum f_i grad w
  for (std::uint32_t k = range.begin; k < range.end; ++k) {
    const auto& node = [&]() -> const auto& {
      if constexpr (Degree == 1) {
        return planes_[cellNodes_[k]];
      } else {
        return packed_[cellNodes_[k]];
      }
    }
    ();
    const float x = p.x() - node.cx, y = p.y() - node.cy, z = p.z() - node.cz;
    const float squared = (x * x + y * y + z * z) * node.inverseSquare;
    if (squared >= 1) continue;
    const float weight = slimWeight(squared);
    const float slope = 2 * slimWeightSlope(squared, weight) * node.inverseSquare;
    float f = x * node.nx + y * node.ny + z * node.nz - node.c0;
    if constexpr (Degree == 1) {
      gx += weight * node.nx, gy += weight * node.ny, gz += weight * node.nz;
    } else {
      const float u = x * node.tx + y * node.ty + z * node.tz, v = x * node.bx + y * node.by + z * node.bz;
      float du = node.c1 + 2 * u * node.c3 + v * node.c4, dv = node.c2 + 2 * v * node.c5 + u * node.c4;
      f -= u * (node.c1 + u * node.c3) + v * (node.c2 + v * node.c5) + u * v * node.c4;
      if constexpr (Degree == 3) {
        f -= u * u * (u * node.c6 + v * node.c7) + v * v * (u * node.c8 + v * node.c9);
        du += u * (3 * u * node.c6 + 2 * v * node.c7) + v * v * node.c8;
        dv += v * (3 * v * node.c9 + 2 * u * node.c8) + u * u * node.c7;
      }
      gx += weight * (node.nx - du * node.tx - dv * node.bx);
      gy += weight * (node.ny - du * node.ty - dv * node.by);
      gz += weight * (node.nz - du * node.tz - dv * node.bz);
    }
    weights += weight, values += weight * f;
    sx += slope * x, sy += slope * y, sz += slope * z;
    fx += slope * f * x, fy += slope * f * y, fz += slope * f * z;
  }
  Value value;
  if (!(weights > 1e-12F)) return value;
  const float inverse = 1 / weights;
  value.weight = weights;
  value.f = values * inverse;
  value.gradient = inverse * Vec3f(gx + fx - value.f * sx, gy + fy - value.f * sy, gz + fz - value.f * sz);
  return value;
}

SlimModel::Value SlimModel::evaluate(const Vec3f& p) const {
  return degree_ == 1 ? evaluateDegree<1>(p) : degree_ == 2 ? evaluateDegree<2>(p) : evaluateDegree<3>(p);
}

void SlimModel::buildDistances(ThreadPool& pool) {
  if (nodes_.empty()) return;
  std::vector<float> radii;
  for (const SlimNode& node : nodes_) radii.push_back(node.radius);
  const auto tenth = static_cast<std::ptrdiff_t>(radii.size() / 10);
  std::nth_element(radii.begin(), radii.begin() + tenth, radii.end());
  const float cell = DistanceGrid::cellFor(bounds_.grown(static_cast<double>(largestRadius_)),
                                           0.5F * radii[static_cast<std::size_t>(tenth)]);
  constexpr std::size_t kAtATime = 64;
  const std::size_t chunks = (nodes_.size() + kAtATime - 1) / kAtATime;
  std::vector<std::vector<OrientedPoint>> parts(chunks);
  pool.run(chunks, [&](std::size_t chunk) {
    for (std::size_t k = chunk * kAtATime; k < std::min(nodes_.size(), (chunk + 1) * kAtATime); ++k) {
      const SlimNode& node = nodes_[k];
      const float reach = kSampledReach * node.radius;
      // No cell is smaller than a few thousandths of all that there is, see DistanceGrid::cellFor().
      const int steps = static_cast<int>(std::ceil(reach / (0.45F * cell)));
      const float step = reach / static_cast<float>(std::max(steps, 1));
      for (int i = -steps; i <= steps; ++i) {
        for (int j = -steps; j <= steps; ++j) {
          const float u = static_cast<float>(i) * step, v = static_cast<float>(j) * step;
          if (u * u + v * v > reach * reach) continue;
          Vec3f p = node.centre + u * node.tangent + v * node.bitangent();
          // Onto the blended surface, unless it is elsewhere.
          Value value;
          for (int round = 0; round < 3; ++round) {
            value = evaluate(p);
            const float squared = value.gradient.squaredNorm();
            if (!(squared > 0.01F)) break;
            p -= value.f / squared * value.gradient;
          }
          if (!(value.gradient.squaredNorm() > 0.01F) || std::abs(value.f) > 0.02F * node.radius ||
              (p - node.centre).squaredNorm() > 1.5F * reach * reach)
            continue;
          parts[chunk].push_back({p, value.gradient.normalized()});
        }
      }
    }
  });
  std::vector<OrientedPoint> points;
  for (const auto& part : parts) points.insert(points.end(), part.begin(), part.end());
  if (points.empty())  // nothing blends to a surface: the centres say where it should be
    for (const SlimNode& node : nodes_) points.push_back({node.centre, node.normal});
  distances_ = std::make_unique<DistanceGrid>(points, closed_, cell);
}

float SlimModel::nearReach() const {
  return distances_ ? kNearCells * distances_->cell() : 0;
}

float SlimModel::coarseDistance(const Vec3f& p) const {
  return distances_->at(p).distance;
}

float SlimModel::coarseError() const {
  return distances_->cell();
}

SlimModel::Nearest SlimModel::nearest(const Vec3f& p) const {
  const DistanceGrid::Sample coarse = distances_->at(p);
  const float length = coarse.gradient.norm();
  Nearest result{coarse.distance, length > 1e-6F ? Vec3f(coarse.gradient / length) : Vec3f(Vec3f::UnitY())};
  const float cell = distances_->cell();
  if (std::abs(coarse.distance) > kNearCells * cell) return result;

  // The foot of p on the tangent plane at a point of the surface near its own foot, again and again.
  Vec3f foot = p - coarse.distance * result.normal;
  for (int round = 0; round < 4; ++round) {
    const Value value = evaluate(foot);
    const float steep = value.gradient.norm();
    if (!(steep > 0.2F)) {
      const DistanceGrid::Sample there = distances_->at(foot);
      foot -= there.distance * there.gradient;
      continue;
    }
    const Vec3f normal = value.gradient / steep;
    const float distance = normal.dot(p - foot) + value.f / steep;
    // Off by more than the coarse grid can be: a crease or another sheet has led the way elsewhere.
    if (std::abs(distance - coarse.distance) > 1.5F * cell) break;
    const Vec3f next = p - distance * normal;
    const float step = (next - foot).norm();
    foot = next;
    // Far away, where the surface bends within the distance, the feet may take long to meet: the grid is
    // right enough there.
    if (step < 0.1F * cell || std::abs(coarse.distance) < cell) result = {distance, normal};
    if (step < 0.01F * cell) break;
  }
  return result;
}

}  // namespace migiwa
