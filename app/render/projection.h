// The camera: its projection onto the picture, and how the mouse moves it.
#pragma once

#include <array>
#include <optional>

#include "core/base/math.h"
#include "core/scene/scene.h"

namespace migiwa {

// The projection: matrices for OpenGL, and the rectangle of the picture that shows the scene.

/// Pixels, origin in the top left corner.
struct Rect {
  int x = 0, y = 0, width = 1, height = 1;
  bool operator==(const Rect&) const = default;
};

using Mat4f = Eigen::Matrix4f;

struct Projection {
  Mat4f view = Mat4f::Identity();  ///< world to camera: right, up, backwards
  Mat4f clip = Mat4f::Identity();  ///< camera to clip space
  double near = 0, far = 0;        ///< distances of the depth range's ends (m)
};

/// To the right in the picture; any direction across the line of sight where that runs along the up axis.
Vec3d cameraRight(const Camera& camera);

/// The camera's vertical field of view holds for the whole picture. Where panels leave only `scene` of it,
/// everything is drawn smaller, so that it still shows what the whole picture would.
Projection makeProjection(const Camera& camera, int pictureWidth, int pictureHeight, const Rect& scene);

/// Where a place (m) is in the picture (pixels); nothing where it lies before the depth range.
std::optional<std::array<float, 2>> pixelOf(const Vec3f& place, const Projection& projection,
                                            const Rect& scene);

// What dragging and scrolling do to a camera. Lengths are metres, angles radians.

/// Turns the eye around the target: about the up axis, then up or down, never over the poles.
void orbit(Camera& camera, double right, double up);
/// Moves eye and target together in the picture's plane.
void pan(Camera& camera, double right, double up);
/// Multiplies the distance to the target.
void zoom(Camera& camera, double factor);
/// Turns towards a point and makes it the new target; the eye stays.
void lookAt(Camera& camera, const Vec3d& point);

}  // namespace migiwa
