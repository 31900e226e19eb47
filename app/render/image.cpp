#include "app/render/image.h"

#include <algorithm>

namespace migiwa {

void Image::paste(const Image& source, int x, int y) {
  for (int row = 0; row < source.height; ++row) {
    const std::uint8_t* from = source.pixel(0, row);
    std::copy(from, from + static_cast<std::ptrdiff_t>(source.width) * 4, pixel(x, y + row));
  }
}

}  // namespace migiwa
