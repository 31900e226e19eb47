#include "core/slim/enclosing_ball.h"

namespace migiwa {

namespace {

/// From the centre of a cube of 3 x 3 x 3 to all others.
constexpr std::array<int, 3> directionOf(std::size_t k) {
  const int cell = static_cast<int>(k < 13 ? k : k + 1);
  return {cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1};
}

}  // namespace

void Extremes::include(const Vec3f& p) {
  for (std::size_t k = 0; k < kDirections; ++k) {
    const auto [x, y, z] = directionOf(k);
    const float reach =
        static_cast<float>(x) * p.x() + static_cast<float>(y) * p.y() + static_cast<float>(z) * p.z();
    if (any_ && reach <= reaches_[k]) continue;
    reaches_[k] = reach;
    points_[k] = p;
  }
  any_ = true;
}

void Extremes::include(const Extremes& other) {
  if (!other.any_) return;
  for (std::size_t k = 0; k < kDirections; ++k) {
    if (any_ && other.reaches_[k] <= reaches_[k]) continue;
    reaches_[k] = other.reaches_[k];
    points_[k] = other.points_[k];
  }
  any_ = true;
}

Vec3f Extremes::centre() const {
  // Badoiu and Clarkson 2003: towards the farthest point, by less and less.
  constexpr int kSteps = 40;
  Vec3f centre = Vec3f::Zero();
  for (const Vec3f& p : points_) centre += p / static_cast<float>(kDirections);
  for (int step = 1; step <= kSteps; ++step) {
    float farthest = -1;
    Vec3f towards = Vec3f::Zero();
    for (const Vec3f& p : points_) {
      const float squared = (p - centre).squaredNorm();
      if (squared <= farthest) continue;
      farthest = squared;
      towards = p - centre;
    }
    centre += towards / static_cast<float>(step + 2);
  }
  return centre;
}

}  // namespace migiwa
