// Draws a frame of a simulation as a scene: ground, particles, walls as lines, surfaces or nodes. Knows frame
// views and cameras, nothing of the solver, of panels, or of windows. The target's context must be current
// for its whole life.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/render/ground_pass.h"
#include "app/render/line_pass.h"
#include "app/render/node_pass.h"
#include "app/render/projection.h"
#include "app/render/render_target.h"
#include "app/render/sphere_pass.h"
#include "app/render/surface_pass.h"
#include "core/simulation/frame_view.h"

namespace migiwa {

/// What stays the same while a scene runs.
struct Surroundings {
  Bounds bounds;
  Vec3d up = Vec3d::UnitY();
  WallDrawing walls;
};

/// How one picture is taken.
struct Shot {
  Camera camera;
  ClipPlane clip;
  ColorField color = ColorField::density;
  std::array<double, 2> colorRange{0, 1};
  bool walls = true;
  bool nodes = false;  ///< the nodes of SLIM walls in place of their surfaces
  Rect scene;          ///< the part of the target that shows the scene
};

class Renderer {
 public:
  Renderer(const Surroundings& surroundings, const ColorMap& colors);

  /// Draws into the target's multisampled buffer, which beginScene() has bound.
  void draw(const FrameView& frame, const Shot& shot, const RenderTarget& target);

  const Ground& ground() const { return ground_; }
  const NodePass& nodes() const { return nodePass_; }

 private:
  void setWalls(const WallDrawing& walls);
  void collectSpheres(const FrameView& frame, const Shot& shot);
  void collectPatches(const Shot& shot);
  void drawSection(const Shot& shot, float width);

  Ground ground_;
  std::vector<WallMesh> meshes_;
  std::vector<Float4> patches_;  ///< of the meshes that face the ground (GroundShadow)
  ClipPlane sectionOf_;          ///< what sectionPass_ holds the outline of
  double sectionSide_ = 0;
  SpherePass spherePass_;
  SurfacePass surfacePass_;
  NodePass nodePass_;
  LinePass linePass_, sectionPass_;
  GroundPass groundPass_;
  GlBuffer uniforms_;
  std::shared_ptr<const WallDrawing> movedWalls_;  ///< that linePass_ shows; null: those of the start
  std::vector<float> values_;
  std::vector<Float4> spheres_, shownPatches_;
};

}  // namespace migiwa
