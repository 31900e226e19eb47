#include "core/boundary/surface.h"

#include <cmath>
#include <limits>

namespace migiwa {

void Surface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  Vec3f normal;
  const float d = distance(p, normal);
  if (std::abs(d) < reach) out.push_back({normal, d, p - d * normal});
}

void Surface::crossings(const Vec3f& origin, const Directions& directions, float reach,
                        std::span<RayCrossings> out) const {
  // A walk along the distance, and the secant where its sign changes: for shapes that know no better.
  constexpr int kSteps = 16;
  Vec3f ignored;
  const float start = distance(origin, ignored);
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].fill(std::numeric_limits<float>::infinity());
    const Vec3f w(directions.x[k], directions.y[k], directions.z[k]);
    std::size_t found = 0;
    float before = start;
    for (int step = 1; step <= kSteps && found < out[k].size(); ++step) {
      const float from = reach * static_cast<float>(step - 1) / kSteps,
                  to = reach * static_cast<float>(step) / kSteps;
      const float here = distance(origin + to * w, ignored);
      if ((here < 0) != (before < 0)) out[k][found++] = from + (to - from) * before / (before - here);
      before = here;
    }
  }
}

}  // namespace migiwa
