#include "core/boundary/surface.h"

#include <cmath>
#include <limits>

namespace migiwa {

void Surface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  Vec3f normal;
  const float d = distance(p, normal);
  if (std::abs(d) < reach) out.push_back({normal, d, p - d * normal});
}

}  // namespace migiwa
