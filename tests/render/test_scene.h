// Small scenes and frames that the render tests share.
#pragma once

#include <filesystem>

#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"

namespace migiwa {

/// A few hundred particles in a box; fills and steps in milliseconds.
Scene smallScene();
/// Spheres of the given diameter (m), coloured by `speeds` (m/s) in x.
FrameSnapshot frameOf(const std::vector<Vec3f>& centers, float diameter, float speed = 0);
/// A fresh folder under the system's temporary one.
std::filesystem::path freshFolder(const std::string& name);

}  // namespace migiwa
