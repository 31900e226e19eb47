#include "tests/render/image_compare.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace migiwa {
namespace {

bool different(const std::uint8_t* a, const std::uint8_t* b) {
  for (int c = 0; c < 4; ++c)
    if (std::abs(a[c] - b[c]) > kTolerance) return true;
  return false;
}

}  // namespace

double differentShare(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) return 1;
  long count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) count += different(&a.rgba[i], &b.rgba[i]) ? 1 : 0;
  return static_cast<double>(count) / (static_cast<double>(a.width) * a.height);
}

Image differencePicture(const Image& expected, const Image& found) {
  Image picture = found;
  if (expected.rgba.size() != found.rgba.size()) return picture;
  for (std::size_t i = 0; i < found.rgba.size(); i += 4) {
    const bool off = different(&expected.rgba[i], &found.rgba[i]);
    const auto grey = static_cast<std::uint8_t>(170 + found.rgba[i + 1] / 4);
    picture.rgba[i] = off ? 220 : grey;
    picture.rgba[i + 1] = picture.rgba[i + 2] = off ? 20 : grey;
  }
  return picture;
}

}  // namespace migiwa
