// What every shader knows of a frame: shaders/frame.glsl declares the same block.
#pragma once

#include <array>

#include "app/render/projection.h"

namespace migiwa {

struct FrameUniforms {
  Mat4f view, clip;
  std::array<float, 4> eye;        ///< world (m)
  std::array<float, 4> up;         ///< world, unit
  std::array<float, 4> clipPlane;  ///< normal towards the camera and offset: cut away where n.p > offset
  std::array<float, 4> viewport;   ///< x, y from the bottom left, width, height (pixels)
  std::array<float, 8> samples;    ///< sample places relative to the pixel's centre (pixels)
};
static_assert(sizeof(FrameUniforms) == 224);

}  // namespace migiwa
