// What is drawn of a scene, a pass each: particles, lines, nodes, surfaces and the ground.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/render/gl.h"
#include "app/render/image.h"
#include "app/render/projection.h"
#include "core/base/math.h"
#include "core/simulation/frame_view.h"
#include "core/walls/surface.h"

namespace migiwa {

/// Of a mesh that is lit.
struct MeshVertex {
  Vec3f position, normal;
};
static_assert(sizeof(MeshVertex) == 6 * sizeof(float), "no padding");

/// Tells `layout` that position and normal are its attributes 0 and 1, and where they and the indices are.
void describeMesh(const GlVertexArray& layout, const GlBuffer& vertices, const GlBuffer& indices);

// Particles as lit spheres: one camera-facing quad each, the sphere found by ray in the fragment shader.

class SpherePass {
 public:
  explicit SpherePass(const ColorMap& colors);
  void setColors(const ColorMap& colors);

  /// `spheres`: centre (m) and, in w, the colour value in [0, 1].
  void draw(std::span<const Float4> spheres, float radius);

 private:
  ShaderProgram program_;
  GlTexture colors_;
  GlBuffer spheres_;
  GlVertexArray layout_;
  std::size_t capacity_ = 0;
};

// Lines of walls, anti-aliased, a fixed number of pixels wide.

class LinePass {
 public:
  LinePass();
  /// From now on draws these.
  void set(std::span<const LineSegment> lines);
  /// Where an opaque line is made of short segments, these do not show.
  void draw(float widthPixels, const std::array<float, 4>& color) const;

 private:
  ShaderProgram program_;
  GlBuffer lines_;
  GlVertexArray layout_;
  GLsizei count_ = 0;
};

// The nodes of SLIM walls as discs, coloured by the radius of their balls and cut by the clip plane. On the
// near side of a vessel only their rims are drawn.

class NodePass {
 public:
  NodePass();
  /// From now on draws these.
  void set(std::span<const WallNode> nodes);

  bool empty() const { return count_ == 0; }
  /// What their colours mean.
  static ColorFieldInfo legend() { return {"radius of the balls", "m"}; }
  /// Radii (m) at the ends of the colour map: those of all but a few balls.
  const std::array<double, 2>& range() const { return range_; }
  void draw() const;

 private:
  ShaderProgram program_;
  GlTexture colors_;
  GlBuffer discs_;
  GlVertexArray layout_;
  GLsizei count_ = 0;
  std::array<double, 2> range_{0, 1};
};

// Walls as shaded surfaces, cut by the clip plane: solids opaque, with the face of the cut in a colour of its
// own; vessels opaque behind the fluid and glass before it.

class SurfacePass {
 public:
  SurfacePass();
  /// From now on draws these.
  void set(std::span<const WallMesh> meshes);

  void drawOpaque() const;
  /// After all that may be seen through it.
  void drawGlass() const;

 private:
  void drawVessels(GLenum culled) const;

  ShaderProgram program_;
  GlBuffer vertices_, indices_;
  GlVertexArray layout_;
  GLsizei solidIndices_ = 0, vesselIndices_ = 0;  ///< in this order in indices_
};

// The liquid's surface as water: it refracts what is behind it, takes light by the way through it and mirrors
// the sky. A ray meets at most two bodies of water, one behind the other.

struct WaterShot {
  Mat4f toClip;                   ///< from the scene
  std::array<float, 4> viewport;  ///< x, y from the bottom left, width, height (pixels)
  Vec3f loss;                     ///< of red, green and blue light in water (1/m)
  float groundHeight = 0;         ///< along the up axis (m)
};

class WaterPass {
 public:
  WaterPass();
  /// From now on draws this one.
  void set(const SurfaceMesh& mesh);
  /// Over what the target holds, which is what is behind the water.
  void draw(const RenderTarget& target, const WaterShot& shot);

 private:
  /// Faces to the air (false) or to walls.
  void drawFaces(const ShaderProgram& program, bool wet) const;
  void drawLayer(const GlFramebuffer& into, GLenum culled, const GlTexture* before) const;
  /// The colours of water that light enters and leaves through these layers.
  void shade(const GlFramebuffer& into, const GlTexture& entries, const GlTexture& exits,
             const GlTexture& behind) const;
  void resize(const RenderTarget& target);
  /// Puts the scissors around the water. False where it is nowhere in the viewport.
  bool keepToWater(const WaterShot& shot) const;

  ShaderProgram layer_, surface_, cover_;
  GlBuffer vertices_, indices_;
  GlVertexArray layout_;
  GLsizei freeIndices_ = 0, wetIndices_ = 0;  ///< in this order in indices_
  Bounds bounds_;                             ///< of the mesh (m)
  int width_ = 0, height_ = 0;
  /// What is behind the water, without and with the water that is seen through other water.
  GlTexture opaque_, all_, depth_;
  /// Where light leaves the water nearest to the eye for it, and comes from further inside; the same of the
  /// water behind; the colours of the nearest.
  GlTexture entries_, exits_, farEntries_, farExits_, colors_;
  GlRenderbuffer entriesDepth_, exitsDepth_, farEntriesDepth_;
  GlFramebuffer toOpaque_, toAll_, toEntries_, toExits_, toFarEntries_, toFarExits_, toColors_;
};

// A picture on a rectangle in space, as it is, without light: a section.

struct Sheet {
  Vec3d corner, across, up;  ///< its lower left corner and its sides (m)
  Image picture;             ///< of alpha 0 where the sheet is not
};

class SheetPass {
 public:
  SheetPass();
  /// From now on draws this one.
  void set(const Sheet& sheet);
  void draw() const;

 private:
  ShaderProgram program_;
  GlTexture picture_;
  GlVertexArray layout_;
};

// The plane under the scene: where it lies and how far apart its grid lines are.

struct Ground {
  Vec3d center = Vec3d::Zero();  ///< of the scene's footprint, in the plane
  Vec3d up = Vec3d::UnitY(), u = Vec3d::UnitX(), v = Vec3d::UnitZ();
  double extent = 1;       ///< longest side of the scene (m)
  double halfSide = 1;     ///< how far the plane reaches from its centre (m)
  double gridSpacing = 1;  ///< (m)

  double heightOf(const Vec3d& p) const { return (p - center).dot(up); }
};

/// `up` picks the axis nearest to it.
Ground makeGround(const Bounds& scene, const Vec3d& up);

// A soft shadow straight under particles and walls, computed from how much of the ground they cover and from
// how high.

class GroundShadow {
 public:
  static constexpr int kSize = 192;  ///< cells along each side

  explicit GroundShadow(const Ground& ground) : ground_(ground) {}

  /// Darkness in [0, 1], row by row along v. `patches`: pieces of walls, with the area that each covers (m^2)
  /// in w.
  std::span<const float> compute(std::span<const Float4> spheres, float radius,
                                 std::span<const Float4> patches);
  /// Half the side of the covered square around the ground's centre (m).
  double halfSide() const { return 0.8 * ground_.extent; }

 private:
  void add(const Float4& place, double area);

  Ground ground_;
  std::vector<float> cells_, scratch_;
};

// What lies behind and under the scene, so that depth can be read: a gradient, a grid on the ground, a soft
// shadow.

class GroundPass {
 public:
  explicit GroundPass(const Ground& ground);
  /// `spheres` and `patches` throw the shadow (GroundShadow); the ground is not drawn from below.
  void draw(std::span<const Float4> spheres, float radius, std::span<const Float4> patches, const Vec3d& eye);

 private:
  Ground ground_;
  GroundShadow shadow_;
  ShaderProgram background_, plane_;
  GlTexture shadowMap_;
  GlVertexArray layout_;
};

}  // namespace migiwa
