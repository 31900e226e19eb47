// A soft shadow straight under particles and walls, computed from how much of the ground they cover and from
// how high.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/render/ground.h"
#include "core/base/types.h"

namespace migiwa {

class GroundShadow {
 public:
  static constexpr int kSize = 192;  ///< cells along each side

  explicit GroundShadow(const Ground& ground) : ground_(ground) {}

  /// Darkness in [0, 1], row by row along v. `patches`: pieces of walls, with the area that each covers (m^2)
  /// in w.
  std::span<const float> compute(std::span<const Float4> spheres, float radius,
                                 std::span<const Float4> patches);
  /// Half the side of the covered square around the ground's centre (m).
  double halfSide() const { return 0.8 * ground_.extent; }

 private:
  void add(const Float4& place, double area);

  Ground ground_;
  std::vector<float> cells_, scratch_;
};

}  // namespace migiwa
