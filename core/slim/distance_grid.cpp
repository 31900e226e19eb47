#include "core/slim/distance_grid.h"

#include <algorithm>
#include <cmath>

namespace migiwa {

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
