#include "app/viewer/reference_speed.h"

#include <algorithm>
#include <cmath>

namespace migiwa {

double referenceSpeed(const Scene& scene) {
  const Vec3d size = scene.bounds().size();
  double speed = std::sqrt(2 * scene.gravity.cwiseAbs().dot(size));
  for (const auto& source : scene.fluid) speed = std::max(speed, source->velocity.norm());
  for (const Emitter& emitter : scene.emitters) speed = std::max(speed, emitter.mouthSpeed());
  if (!(speed > 0) || !std::isfinite(speed)) return 1;
  const double digit = std::pow(10, std::floor(std::log10(speed)));
  return std::max(1.0, std::round(speed / digit)) * digit;
}

}  // namespace migiwa
