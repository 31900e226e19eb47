#include "app/render/color_texture.h"

namespace migiwa {

GlTexture makeColorTexture(const ColorMap& colors) {
  GlTexture texture = makeTexture(GL_TEXTURE_1D);
  glTextureStorage1D(texture.name(), 1, GL_SRGB8, kColorMapSize);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage1D(texture.name(), 0, 0, kColorMapSize, GL_RGB, GL_UNSIGNED_BYTE, colors.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace migiwa
