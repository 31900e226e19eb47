#include "app/render/png.h"

#include <stdexcept>

#include <stb_image_write.h>

namespace migiwa {

std::string encodePng(const Image& image) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.rgba.data(),
                              image.width * 4)) {
    throw std::runtime_error("a picture of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels cannot be encoded");
  }
  return bytes;
}

}  // namespace migiwa
