// A scene as a value: everything a simulation and a picture need, validated, free of JSON. Surfaces, sources
// and effects are shared and never change after reading, so a scene can be copied and handed around.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/boundary/surface.h"
#include "core/effects/effect.h"
#include "core/scene/color_field.h"
#include "core/scene/emitter.h"
#include "core/scene/fluid_source.h"
#include "core/solver/parameters.h"

namespace migiwa {

struct Camera {
  Vec3d eye{3, 2, 5};     ///< (unit: m)
  Vec3d target{0, 0, 0};  ///< (unit: m)
  Vec3d up{0, 1, 0};
  double fovDegrees = 40;  ///< vertical field of view (unit: degrees, range: [1, 120])

  bool operator==(const Camera&) const = default;
};

enum class Axis { x, y, z };
inline constexpr std::array<std::string_view, 3> kAxisNames{"x", "y", "z"};

/// What lies beyond the plane towards the camera is cut away.
struct ClipPlane {
  bool enabled = false;
  Axis axis = Axis::z;
  double at = 0;  ///< (unit: m)

  bool operator==(const ClipPlane&) const = default;
};

struct View {
  Camera camera;
  ClipPlane clip;
  bool nodes = false;  ///< SLIM walls as the discs of their nodes instead of their surface
  ColorField color = ColorField::density;
  bool hasColorRange = false;
  std::array<double, 2> colorRange{
      0, 1};  ///< ends of the colour map, in the field's unit; used if hasColorRange

  bool operator==(const View&) const = default;
};

struct Scene {
  std::filesystem::path file;  ///< where it was read from
  std::string name;
  std::string description;
  double duration = 4;            ///< (unit: s)
  double particleSpacing = 0.05;  ///< (unit: m)
  Vec3d gravity{0, -9.81, 0};     ///< (unit: m/s^2)
  std::vector<std::shared_ptr<const FluidSource>> fluid;
  std::vector<Emitter> emitters;
  std::vector<std::shared_ptr<const Surface>> surfaces;
  BoundaryParameters boundary;
  SolverParameters solver;
  std::vector<NamedEffect> effects;
  View view;
  std::vector<std::string> warnings;  ///< what is valid and probably not meant, one sentence each

  std::string stem() const { return file.stem().string(); }
  double supportRadius() const { return solver.supportRatio * particleSpacing; }
  /// Extent of fluid and finite walls, wherever they are within the duration.
  Bounds bounds() const;
};

}  // namespace migiwa
