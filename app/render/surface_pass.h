// Walls as shaded surfaces, cut by the clip plane: solids opaque, with the face of the cut in a colour of its
// own; vessels opaque behind the fluid and glass before it.
#pragma once

#include <span>

#include "app/render/shader_program.h"
#include "core/boundary/wall_drawing.h"

namespace migiwa {

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

}  // namespace migiwa
