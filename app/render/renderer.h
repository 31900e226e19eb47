// Draws a frame of a simulation as a scene: ground, particles, walls as lines, surfaces or nodes. Knows frame
// views and cameras, nothing of the solver, of panels, or of windows. The target's context must be current
// for its whole life.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/render/image.h"
#include "app/render/passes.h"
#include "app/render/projection.h"
#include "core/simulation/frame_view.h"
#include "core/walls/surface.h"

namespace migiwa {

/// What stays the same while a scene runs.
struct Surroundings {
  Bounds bounds;
  Vec3d up = Vec3d::UnitY();
  WallDrawing walls;
  std::vector<LineSegment> mouths, drains;  ///< outlines of what gives fluid, and of what takes it
};

/// What lies beyond a plane towards the camera is cut away, in place of a clip plane.
struct CutPlane {
  Vec3d normal = Vec3d::UnitZ();  ///< unit
  double at = 0;                  ///< from the origin along it (m)
  bool operator==(const CutPlane&) const = default;
};

/// How one picture is taken.
struct Shot {
  Camera camera;
  ClipPlane clip;
  ColorField color = ColorField::density;
  std::array<double, 2> colorRange{0, 1};
  bool walls = true;
  bool nodes = false;                    ///< the nodes of SLIM walls in place of their surfaces
  Rect scene;                            ///< the part of the target that shows the scene
  Vec3f waterLoss = Vec3f::Zero();       ///< of red, green and blue light in water (1/m)
  std::optional<CutPlane> cut{};         ///< nothing: `clip` is what counts
  std::shared_ptr<const Sheet> sheet{};  ///< null: none

  bool operator==(const Shot&) const = default;
};

/// The plane that the shot is cut at, its normal towards the camera.
std::optional<CutPlane> cutOf(const Shot& shot);
/// Whether it cuts away what is at p.
bool isCut(const Shot& shot, const Vec3f& p);

struct FrameUniforms;

class Renderer {
 public:
  Renderer(const Surroundings& surroundings, const ColorMap& colors);

  /// Draws into the target's multisampled buffer, which beginScene() has bound. A frame that has the water's
  /// surface shows it in place of the particles, whole where a clip plane would cut.
  void draw(const FrameView& frame, const Shot& shot, const RenderTarget& target);

  /// Of particles, from now on.
  void setColors(const ColorMap& colors) { spherePass_.setColors(colors); }

  const Ground& ground() const { return ground_; }
  const NodePass& nodes() const { return nodePass_; }
  /// Whether some walls are drawn as surfaces, which hide what is behind them.
  bool hasSurfaces() const { return !meshes_.empty(); }

 private:
  void setWalls(const WallDrawing& walls);
  void collectSpheres(const FrameView& frame, const Shot& shot);
  void collectPatches(const Shot& shot);
  void drawSection(const Shot& shot, float width);
  void drawLines(float width) const;
  void drawSheet(const Shot& shot);
  void drawWater(const FrameView& frame, const Shot& shot, const FrameUniforms& uniforms,
                 const RenderTarget& target);

  Ground ground_;
  std::vector<WallMesh> meshes_;
  std::vector<Float4> patches_;        ///< of the meshes that face the ground (GroundShadow)
  std::optional<CutPlane> sectionOf_;  ///< what sectionPass_ holds the outline of
  SpherePass spherePass_;
  SurfacePass surfacePass_;
  NodePass nodePass_;
  LinePass linePass_, sectionPass_, mouthPass_, drainPass_;
  GroundPass groundPass_;
  GlBuffer uniforms_;
  std::optional<SheetPass> sheetPass_;             ///< once a sheet has been drawn
  std::shared_ptr<const Sheet> sheet_;             ///< that sheetPass_ shows
  std::optional<WaterPass> waterPass_;             ///< once water has been drawn
  std::shared_ptr<const SurfaceMesh> water_;       ///< that waterPass_ shows
  std::shared_ptr<const WallDrawing> movedWalls_;  ///< that linePass_ shows; null: those of the start
  std::vector<float> values_;
  std::vector<Float4> spheres_, shownPatches_;
};

// What every shader knows of a frame: shaders/frame.glsl declares the same block.

struct FrameUniforms {
  Mat4f view, clip;
  std::array<float, 4> eye;        ///< world (m)
  std::array<float, 4> up;         ///< world, unit
  std::array<float, 4> clipPlane;  ///< normal towards the camera and offset: cut away where n.p > offset
  std::array<float, 4> viewport;   ///< x, y from the bottom left, width, height (pixels)
  std::array<float, 8> samples;    ///< sample places relative to the pixel's centre (pixels)
};
static_assert(sizeof(FrameUniforms) == 224);

// Where a plane cuts surfaces: the outline of the cut.

std::vector<LineSegment> sectionLines(std::span<const WallMesh> meshes, const CutPlane& plane);

}  // namespace migiwa
