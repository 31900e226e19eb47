// Pictures as PNG; the same picture always gives the same bytes.
#pragma once

#include <string>

#include "app/render/image.h"

namespace migiwa {

/// The bytes of a PNG file.
std::string encodePng(const Image& image);

}  // namespace migiwa
