// The camera of a scene that names none.
#pragma once

#include "core/scene/scene.h"

namespace migiwa {

/// Sees all of `bounds` (m) from the front, a little from above and from the right; up is against gravity
/// (m/s^2).
Camera defaultCamera(const Bounds& bounds, const Vec3d& gravity);

}  // namespace migiwa
