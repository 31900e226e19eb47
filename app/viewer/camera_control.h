// What dragging and scrolling do to a camera. Lengths are metres, angles radians.
#pragma once

#include "core/scene/scene.h"

namespace migiwa {

/// Turns the eye around the target: about the up axis, then up or down, never over the poles.
void orbit(Camera& camera, double right, double up);
/// Moves eye and target together in the picture's plane.
void pan(Camera& camera, double right, double up);
/// Multiplies the distance to the target.
void zoom(Camera& camera, double factor);
/// Turns towards a point and makes it the new target; the eye stays.
void lookAt(Camera& camera, const Vec3d& point);

}  // namespace migiwa
