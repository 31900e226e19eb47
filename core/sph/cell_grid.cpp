#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/sph/neighbours.h"

namespace migiwa {

namespace {

struct Box {
  Vec3f min = Vec3f::Constant(std::numeric_limits<float>::infinity());
  Vec3f max = Vec3f::Constant(-std::numeric_limits<float>::infinity());
};

Box boundingBox(std::span<const Float4> positions, ThreadPool& pool) {
  return parallelReduce(
      pool, positions.size(), Box{},
      [&](std::size_t begin, std::size_t end) {
        Box box;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3f p = positions[i].xyz();
          for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(p[axis])) continue;
            box.min[axis] = std::min(box.min[axis], p[axis]);
            box.max[axis] = std::max(box.max[axis], p[axis]);
          }
        }
        return box;
      },
      [](Box a, const Box& b) {
        a.min = a.min.cwiseMin(b.min);
        a.max = a.max.cwiseMax(b.max);
        return a;
      });
}

}  // namespace

int CellGrid::index(float offset, int axis) const {
  // Clamped as float first: a cast of what does not fit an int is undefined. What is not finite is kept in
  // the first cell, whose particles find it out of reach.
  const float scaled = std::floor(offset * inverseCell_);
  if (!std::isfinite(scaled)) return 0;
  const auto last = static_cast<float>(size_[axis]);
  return static_cast<int>(std::clamp(scaled, -1.0F, last));
}

void CellGrid::build(std::span<const Float4> positions, float cellSize, ThreadPool& pool) {
  const std::size_t n = positions.size();
  order_.resize(n);
  keys_.resize(n);
  fullest_ = 0;
  if (n == 0) {
    start_.assign(2, 0);
    size_[0] = size_[1] = size_[2] = 1;
    return;
  }
  Box box = boundingBox(positions, pool);
  // Without a single finite coordinate along an axis the box has no place there.
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) box.min[axis] = box.max[axis] = 0;
  originX_ = box.min.x(), originY_ = box.min.y(), originZ_ = box.min.z();
  const Vec3d extent = (box.max.cast<double>() - box.min.cast<double>()).cwiseMax(0.0);

  // A cell a little wider than the radius: rounding can then never put a neighbour two cells away.
  double size = static_cast<double>(cellSize) * 1.0001;
  const double most = 4.0 * static_cast<double>(n) + 4096;
  const auto cellsAlong = [&](int axis) { return std::floor(extent[axis] / size) + 1; };
  while (cellsAlong(0) * cellsAlong(1) * cellsAlong(2) > most) size *= 1.5;
  inverseCell_ = static_cast<float>(1 / size);
  for (int axis = 0; axis < 3; ++axis) size_[axis] = static_cast<int>(cellsAlong(axis)) + 1;

  parallelFor(pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Cell cell = cellOf(positions[i]);
      keys_[i] = static_cast<std::uint32_t>((cell.z * size_[1] + cell.y) * size_[0] + cell.x);
    }
  });

  const std::size_t cells = static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                            static_cast<std::size_t>(size_[2]);
  start_.assign(cells + 1, 0);
  for (const std::uint32_t key : keys_) ++start_[key + 1];
  std::uint32_t fullest = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    fullest = std::max(fullest, start_[c + 1]);
    start_[c + 1] += start_[c];
  }
  fullest_ = fullest;
  // Filling backwards moves each cell's end to its start and keeps the particles of a cell in their order.
  std::vector<std::uint32_t>& place = start_;
  for (std::size_t i = n; i-- > 0;) order_[--place[keys_[i] + 1]] = static_cast<std::uint32_t>(i);
  // place[c + 1] is now the start of cell c: shift back by one.
  std::move(start_.begin() + 1, start_.end(), start_.begin());
  start_[cells] = static_cast<std::uint32_t>(n);
}

CellGrid::Places CellGrid::row(int x0, int x1, int y, int z) const {
  if (y < 0 || z < 0 || y >= size_[1] || z >= size_[2]) return {};
  x0 = std::max(x0, 0);
  x1 = std::min(x1, size_[0] - 1);
  if (x0 > x1) return {};
  const std::size_t first =
      (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(y)) *
      static_cast<std::size_t>(size_[0]);
  return {start_[first + static_cast<std::size_t>(x0)], start_[first + static_cast<std::size_t>(x1) + 1]};
}

}  // namespace migiwa
