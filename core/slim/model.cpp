#include "core/slim/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

namespace {

/// Vertices of the grid along its longest side, at most: 8 MB.
constexpr float kMostVertices = 128;
/// Cells around the surface.
constexpr float kMargin = 6;
/// Cells from a point of the surface within which vertices get it straight away.
constexpr int kBand = 2;

}  // namespace

float DistanceGrid::cellFor(const Bounds& bounds, float detail) {
  const auto extent = static_cast<float>(bounds.size().maxCoeff());
  return std::max({detail, extent / (kMostVertices - 2 * kMargin), 1e-6F});
}

DistanceGrid::DistanceGrid(const std::vector<OrientedPoint>& points, bool closed, float cell)
    : cell_(cell), inverseCell_(1 / cell) {
  Bounds bounds;
  for (const OrientedPoint& point : points) bounds.include(point.position.cast<double>());
  origin_ = bounds.min.cast<float>().array() - kMargin * cell;
  for (int axis = 0; axis < 3; ++axis)
    size_[axis] =
        static_cast<int>(std::ceil(static_cast<float>(bounds.size()[axis]) * inverseCell_ + 2 * kMargin)) + 1;
  const auto vertices = static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                        static_cast<std::size_t>(size_.z());
  std::vector<std::int32_t> nearest(vertices, -1);

  std::vector<std::uint8_t> band(vertices, 0);
  distances_.assign(vertices, 0);  // squared, so far
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3f& p = points[k].position;
    const Vec3f local = (p - origin_) * inverseCell_;
    const Eigen::Vector3i base(static_cast<int>(local.x()), static_cast<int>(local.y()),
                               static_cast<int>(local.z()));
    for (int z = base.z() - kBand + 1; z <= base.z() + kBand; ++z) {
      for (int y = base.y() - kBand + 1; y <= base.y() + kBand; ++y) {
        for (int x = base.x() - kBand + 1; x <= base.x() + kBand; ++x) {
          const std::size_t at = index(x, y, z);
          const float squared = (vertex(x, y, z) - p).squaredNorm();
          if (band[at] != 0 && squared >= distances_[at]) continue;
          band[at] = 1;
          distances_[at] = squared;
          nearest[at] = static_cast<std::int32_t>(k);
        }
      }
    }
  }
  spread(points, nearest);
  for (int z = 0; z < size_.z(); ++z) {
    for (int y = 0; y < size_.y(); ++y) {
      for (int x = 0; x < size_.x(); ++x) {
        const std::size_t at = index(x, y, z);
        const OrientedPoint& point = points[static_cast<std::size_t>(nearest[at])];
        const Vec3f offset = vertex(x, y, z) - point.position;
        const float length = offset.norm(), along = offset.dot(point.normal);
        // The foot lies between the points: near the surface, the tangent plane is nearer the truth than the
        // point.
        const bool flat = length < 2 * cell_ && std::abs(along) > 0.8F * length;
        distances_[at] = flat ? along : std::copysign(length, along);
      }
    }
  }
  if (closed) agreeOnSigns(band);
}

void DistanceGrid::spread(const std::vector<OrientedPoint>& points,
                          std::vector<std::int32_t>& nearest) const {
  // Raster scans to and fro: every vertex takes the nearest of its neighbours' points (Danielsson 1980).
  const auto adopt = [&](int x, int y, int z, int dx, int dy, int dz) {
    const int ox = x + dx, oy = y + dy, oz = z + dz;
    if (ox < 0 || oy < 0 || oz < 0 || ox >= size_.x() || oy >= size_.y() || oz >= size_.z()) return;
    const std::int32_t theirs = nearest[index(ox, oy, oz)];
    std::int32_t& mine = nearest[index(x, y, z)];
    if (theirs < 0 || theirs == mine) return;
    const Vec3f at = vertex(x, y, z);
    if (mine < 0 || (at - points[static_cast<std::size_t>(theirs)].position).squaredNorm() <
                        (at - points[static_cast<std::size_t>(mine)].position).squaredNorm())
      mine = theirs;
  };
  for (int round = 0; round < 2; ++round) {
    for (int z = 0; z < size_.z(); ++z) {
      for (int y = 0; y < size_.y(); ++y) {
        for (int x = 0; x < size_.x(); ++x)
          adopt(x, y, z, 0, 0, -1), adopt(x, y, z, 0, -1, 0), adopt(x, y, z, -1, 0, 0),
              adopt(x, y, z, 0, -1, -1);
        for (int x = size_.x() - 1; x >= 0; --x) adopt(x, y, z, 1, 0, 0);
      }
      for (int y = size_.y() - 1; y >= 0; --y)
        for (int x = 0; x < size_.x(); ++x) adopt(x, y, z, 0, 1, 0);
    }
    for (int z = size_.z() - 1; z >= 0; --z) {
      for (int y = size_.y() - 1; y >= 0; --y) {
        for (int x = size_.x() - 1; x >= 0; --x)
          adopt(x, y, z, 0, 0, 1), adopt(x, y, z, 0, 1, 0), adopt(x, y, z, 1, 0, 0), adopt(x, y, z, 0, 1, 1);
        for (int x = 0; x < size_.x(); ++x) adopt(x, y, z, -1, 0, 0);
      }
      for (int y = 0; y < size_.y(); ++y)
        for (int x = 0; x < size_.x(); ++x) adopt(x, y, z, 0, -1, 0);
    }
  }
}

void DistanceGrid::agreeOnSigns(const std::vector<std::uint8_t>& band) {
  // Away from the surface a wrong normal must not decide: every region that the band leaves takes the sign
  // that most of the band around it has.
  std::vector<std::uint8_t> seen = band;
  std::vector<std::size_t> region;
  const std::size_t strideY = static_cast<std::size_t>(size_.x());
  const std::size_t strideZ = strideY * static_cast<std::size_t>(size_.y());
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start] != 0) continue;
    region.assign(1, start);
    seen[start] = 1;
    long votes = 0;
    bool outer = false;
    for (std::size_t k = 0; k < region.size(); ++k) {
      const std::size_t at = region[k];
      const int x = static_cast<int>(at % strideY),
                y = static_cast<int>(at / strideY % static_cast<std::size_t>(size_.y())),
                z = static_cast<int>(at / strideZ);
      const auto visit = [&](bool there, std::size_t other) {
        if (!there) {
          outer = true;
          return;
        }
        if (band[other] != 0) votes += distances_[other] < 0 ? -1 : 1;
        if (seen[other] != 0) return;
        seen[other] = 1;
        region.push_back(other);
      };
      visit(x > 0, at - 1), visit(x + 1 < size_.x(), at + 1);
      visit(y > 0, at - strideY), visit(y + 1 < size_.y(), at + strideY);
      visit(z > 0, at - strideZ), visit(z + 1 < size_.z(), at + strideZ);
    }
    const float sign = outer || votes >= 0 ? 1.0F : -1.0F;
    for (const std::size_t at : region) distances_[at] = sign * std::abs(distances_[at]);
  }
}

DistanceGrid::Sample DistanceGrid::at(const Vec3f& p) const {
  const Vec3f last = (size_.cast<float>().array() - 1.001F).matrix();
  const Vec3f raw = (p - origin_) * inverseCell_;
  Vec3f local;
  // In this order what is not a number becomes the first node.
  for (int axis = 0; axis < 3; ++axis) local[axis] = std::min(std::max(0.0F, raw[axis]), last[axis]);
  const int x = static_cast<int>(local.x()), y = static_cast<int>(local.y()), z = static_cast<int>(local.z());
  const float u = local.x() - static_cast<float>(x), v = local.y() - static_cast<float>(y),
              w = local.z() - static_cast<float>(z);
  const float* row = &distances_[index(x, y, z)];
  const auto strideY = static_cast<std::size_t>(size_.x());
  const std::size_t strideZ = strideY * static_cast<std::size_t>(size_.y());
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const float a00 = row[0], a10 = row[1], a01 = row[strideY], a11 = row[strideY + 1];
  const float b00 = row[strideZ], b10 = row[strideZ + 1], b01 = row[strideZ + strideY],
              b11 = row[strideZ + strideY + 1];
  const float a0 = mix(a00, a10, u), a1 = mix(a01, a11, u), b0 = mix(b00, b10, u), b1 = mix(b01, b11, u);
  const float a = mix(a0, a1, v), b = mix(b0, b1, v);
  Sample sample;
  sample.distance = mix(a, b, w);
  sample.gradient = inverseCell_ * Vec3f(mix(mix(a10 - a00, a11 - a01, v), mix(b10 - b00, b11 - b01, v), w),
                                         mix(a1 - a0, b1 - b0, w), b - a);
  const Vec3f beyond = (raw - local) * cell_;
  if (beyond.squaredNorm() > cell_ * cell_ * 1e-4F) {
    // Outside the grid: on from its border, away from the foot of the border's point.
    // Near the medial axis nothing tells where that is: across, then.
    const float steep = sample.gradient.norm();
    const bool known = steep > 0.5F;
    const Vec3f away = beyond + (known ? sample.distance / steep : 0) * sample.gradient;
    const float length =
        known ? away.norm() : std::sqrt(beyond.squaredNorm() + sample.distance * sample.distance);
    sample.distance = std::copysign(length, sample.distance);
    sample.gradient = away / std::copysign(std::max(away.norm(), 1e-12F), sample.distance);
  }
  return sample;
}

}  // namespace migiwa
