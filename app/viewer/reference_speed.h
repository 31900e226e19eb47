// The speed that fills the colour map when pictures show speed.
#pragma once

#include "core/scene/scene.h"

namespace migiwa {

/// That of a fall from the top of the scene to its bottom, or of the fastest source, rounded to one digit
/// (m/s).
double referenceSpeed(const Scene& scene);

}  // namespace migiwa
