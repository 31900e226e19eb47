// Draws a frame of a simulation as a scene: ground, particles, walls. Knows frame views and cameras, nothing
// of the solver, of panels, or of windows. The target's context must be current for its whole life.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/render/ground_pass.h"
#include "app/render/line_pass.h"
#include "app/render/projection.h"
#include "app/render/render_target.h"
#include "app/render/sphere_pass.h"
#include "core/simulation/frame_view.h"

namespace migiwa {

/// What stays the same while a scene runs.
struct Surroundings {
  Bounds bounds;
  Vec3d up = Vec3d::UnitY();
  std::vector<LineSegment> walls;
};

/// How one picture is taken.
struct Shot {
  Camera camera;
  ClipPlane clip;
  ColorField color = ColorField::density;
  std::array<double, 2> colorRange{0, 1};
  bool walls = true;
  Rect scene;  ///< the part of the target that shows the scene
};

class Renderer {
 public:
  Renderer(const Surroundings& surroundings, const ColorMap& colors);

  /// Draws into the target's multisampled buffer, which beginScene() has bound.
  void draw(const FrameView& frame, const Shot& shot, const RenderTarget& target);

  const Ground& ground() const { return ground_; }

 private:
  void collectSpheres(const FrameView& frame, const Shot& shot);

  Ground ground_;
  SpherePass spherePass_;
  LinePass linePass_;
  GroundPass groundPass_;
  GlBuffer uniforms_;
  std::shared_ptr<const std::vector<LineSegment>>
      movedWalls_;  ///< that linePass_ shows; null: those of the start
  std::vector<float> values_;
  std::vector<Float4> spheres_;
};

}  // namespace migiwa
