#include "core/slim/direction_bins.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace migiwa {

bool DirectionBins::matches(const DirectionSet& directions) const {
  const std::size_t n = directions.size();
  if (known_.size() != 3 * n || n == 0) return false;
  return std::memcmp(known_.data(), directions.x.data(), n * sizeof(float)) == 0 &&
         std::memcmp(known_.data() + n, directions.y.data(), n * sizeof(float)) == 0 &&
         std::memcmp(known_.data() + 2 * n, directions.z.data(), n * sizeof(float)) == 0;
}

void DirectionBins::build(const DirectionSet& directions) {
  const std::size_t n = directions.size();
  known_.clear();
  for (const auto& part : {directions.x, directions.y, directions.z})
    known_.insert(known_.end(), part.begin(), part.end());
  bins_.clear();
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  if (n > 0) split(order);

  const std::size_t groups = (bins_.size() + kLanes - 1) / kLanes;
  for (auto* part : {&axisX_, &axisY_, &axisZ_, &sine_}) part->assign(groups, FourFloats{});
  cosine_.assign(groups, FourFloats{} + 2.0F);  // never seen
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const Bin& bin = bins_[k];
    Vec3f axis = Vec3f::Zero();
    for (std::size_t lane = 0; lane < kLanes; ++lane) axis += Vec3f(bin.x[lane], bin.y[lane], bin.z[lane]);
    axis.normalize();
    float cosine = 1;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      cosine = std::min(cosine, axis.dot(Vec3f(bin.x[lane], bin.y[lane], bin.z[lane])));
    cosine -= 1e-5F;  // rounding must not lose a direction at the rim
    const std::size_t group = k / kLanes, lane = k % kLanes;
    axisX_[group][lane] = axis.x(), axisY_[group][lane] = axis.y(), axisZ_[group][lane] = axis.z();
    cosine_[group][lane] = cosine;
    sine_[group][lane] = std::sqrt(std::max(1 - cosine * cosine, 0.0F));
  }
}

void DirectionBins::split(std::span<std::uint32_t> order) {
  const std::size_t n = known_.size() / 3;
  const auto coordinate = [&](std::uint32_t k, int axis) {
    return known_[static_cast<std::size_t>(axis) * n + k];
  };
  if (order.size() <= kLanes) {
    Bin bin{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Missing ones repeat the first, so that the cone stays as it is.
      const std::uint32_t k = order[lane < order.size() ? lane : 0];
      bin.x[lane] = coordinate(k, 0), bin.y[lane] = coordinate(k, 1), bin.z[lane] = coordinate(k, 2);
      bin.index[lane] = lane < order.size() ? k : kNone;
    }
    bins_.push_back(bin);
    return;
  }
  int axis = 0;
  float widest = -1;
  for (int candidate = 0; candidate < 3; ++candidate) {
    const auto [least, most] =
        std::minmax_element(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
          return coordinate(a, candidate) < coordinate(b, candidate);
        });
    const float width = coordinate(*most, candidate) - coordinate(*least, candidate);
    if (width > widest) widest = width, axis = candidate;
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float p = coordinate(a, axis), q = coordinate(b, axis);
    return p != q ? p < q : a < b;
  });
  // Whole bins on the left.
  const std::size_t middle = (order.size() / 2 + kLanes - 1) / kLanes * kLanes;
  split(order.first(middle));
  split(order.subspan(middle));
}

}  // namespace migiwa
