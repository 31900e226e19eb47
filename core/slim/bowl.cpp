#include "core/slim/bowl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"

namespace migiwa {

double bowlDistance(const Bowl& bowl, const Vec3d& p, Vec3d& normal) {
  const Vec3d q = p - bowl.center;
  const double length = q.norm(), across = portable::hypot(q.x(), q.z());
  Vec3d foot;  // on the half sphere, or on the cylinder
  if (q.y() <= 0) {
    foot = length > 0 ? Vec3d(bowl.radius / length * q) : Vec3d(0, -bowl.radius, 0);
  } else {
    foot = across > 0 ? Vec3d(bowl.radius / across * Vec3d(q.x(), 0, q.z())) : Vec3d(bowl.radius, 0, 0);
    foot.y() = std::min(q.y(), bowl.height);
  }
  const Vec3d offset = q - foot;
  const double away = offset.norm();
  normal = away > 0 ? Vec3d(offset / away) : Vec3d(foot / bowl.radius);
  return away - 0.5 * bowl.thickness;
}

OrientedPoints bowlPoints(const Bowl& bowl, std::size_t count) {
  constexpr double kPi = std::numbers::pi;
  const double half = 0.5 * bowl.thickness;
  const double inner = bowl.radius - half, outer = bowl.radius + half;
  const double areas[] = {2 * kPi * inner * (inner + bowl.height), 2 * kPi * outer * (outer + bowl.height),
                          // Half a torus, the upper one: Pappus.
                          kPi * half * 2 * kPi * bowl.radius};
  const double total = areas[0] + areas[1] + areas[2];
  OrientedPoints result;
  for (int part = 0; part < 3; ++part) {
    const auto n = static_cast<std::size_t>(std::round(areas[part] / total * static_cast<double>(count)));
    for (std::size_t k = 0; k < n; ++k) {
      // Even in height and by the golden angle around: a Fibonacci set on each part.
      const double along = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
      const double angle = kPi * (3 - std::sqrt(5.0)) * static_cast<double>(k);
      Vec3d around(portable::cos(angle), 0, portable::sin(angle)), normal, foot;
      if (part < 2) {
        // By Archimedes, a sphere has as much area as its cylinder at the same height: the way goes down from
        // the rim to the bottom at one speed.
        const double own = part == 0 ? inner : outer;
        const double down =
            along * (1 + bowl.height / own) - bowl.height / own;  // below the centre, by `own`
        const double sine = -std::max(0.0, down);
        normal = std::sqrt(1 - sine * sine) * around + sine * Vec3d::UnitY();
        foot = bowl.radius * normal + std::max(0.0, -down) * own * Vec3d::UnitY();
        if (part == 0) normal = -normal;
      } else {
        // From the outer side over the top to the inner one; the circumference shrinks on the way, so equal
        // areas are not equal angles: solve angle + (half / radius) sin(angle) = share of the whole by
        // Newton.
        const double ratio = half / bowl.radius;
        double turn = along * kPi;
        for (int step = 0; step < 20; ++step)
          turn -= (turn + ratio * portable::sin(turn) - along * kPi) / (1 + ratio * portable::cos(turn));
        normal = portable::cos(turn) * around + portable::sin(turn) * Vec3d::UnitY();
        foot = bowl.radius * around + bowl.height * Vec3d::UnitY();
      }
      const Vec3d p = bowl.center + foot + half * normal;
      result.points.push_back({p.cast<float>(), normal.cast<float>()});
    }
  }
  return result;
}

}  // namespace migiwa
