// A colour map as a texture that interpolates between its entries in linear light.
#pragma once

#include "app/render/color_map.h"
#include "app/render/gl_objects.h"

namespace migiwa {

GlTexture makeColorTexture(const ColorMap& colors);

}  // namespace migiwa
