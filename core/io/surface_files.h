// Surfaces in files for other programs, and exported particles read back to make them from.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/surface/mesh.h"

namespace migiwa {

// Meshes as files.

struct SurfaceFrame {
  const SurfaceMesh& mesh;
  double time = 0;               ///< (s)
  Vec3d origin = Vec3d::Zero();  ///< Scene::origin (m); files have the sum, in double where it is not zero
};

struct SurfaceFormat {
  std::string_view name;   ///< as asked for; also the ending of the files
  std::string_view holds;  ///< what of a mesh, for people
  std::string (*text)(const SurfaceFrame& frame);
};

/// The first is the one that is written unless another is asked for.
std::span<const SurfaceFormat> surfaceFormats();

/// What a script that renders meshes has to know. Places as in the meshes' files (m).
struct BlenderView {
  std::string list;           ///< name of the file that lists the meshes, beside the script
  Vec3d eye, target, ground;  ///< the camera's places, and a point of the ground
  double fov = 0.7;           ///< vertical field of view (rad)
  double size = 1;            ///< of what is seen (m)
};

/// A Python script for `blender -b -P`: water that refracts and absorbs, on a ground, under a sky and a sun.
std::string blenderScript(const BlenderView& view);

// Particles from files: those that `simulate --export` writes as PLY and VTK, and others that hold as much.

struct ImportedParticles {
  std::vector<Float4> positions;   ///< (m), relative to the origin that was asked for
  std::vector<Float4> velocities;  ///< (m/s); empty where the file has none
  std::optional<double> time;      ///< (s), where the file says it
};

/// Reads vertices of a PLY file (binary little-endian or ASCII) or points of a legacy VTK file (binary).
/// There may be none. Throws InputError at the file, where it is neither, ends too soon, or holds a particle
/// that is at no finite place.
ImportedParticles readParticles(const std::filesystem::path& file, const Vec3d& origin = Vec3d::Zero());

}  // namespace migiwa
