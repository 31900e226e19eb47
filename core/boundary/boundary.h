// All walls of a scene together: the fluid is on the fluid side of every surface.
#pragma once

#include <memory>
#include <vector>

#include "core/boundary/surface.h"

namespace migiwa {

class Boundary {
 public:
  Boundary() = default;
  explicit Boundary(std::vector<std::shared_ptr<const Surface>> surfaces) : surfaces_(std::move(surfaces)) {}

  bool empty() const { return surfaces_.empty(); }
  const std::vector<std::shared_ptr<const Surface>>& surfaces() const { return surfaces_; }

  /// Distance to the nearest wall (m), positive in the fluid, infinite without walls; and its normal.
  float distance(const Vec3f& p, Vec3f& normal) const;
  float distance(const Vec3f& p) const;

  /// Moves p until every wall is at least `margin` (m) away, or midway where walls leave no room. Returns
  /// whether it moved.
  bool project(Vec3f& p, float margin) const;

 private:
  bool projectInTurn(Vec3f& p, float margin, bool& fits) const;

  std::vector<std::shared_ptr<const Surface>> surfaces_;
};

}  // namespace migiwa
