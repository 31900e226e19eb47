#include "app/ui/fonts.h"

#include <filesystem>

#include "core/base/error.h"

namespace migiwa {
namespace {

ImFont* load(const char* name, float pixels) {
  // ImGui keeps a pointer to the ranges until the atlas is built.
  static constexpr ImWchar kRanges[] = {0x20,   0xFF,    // Latin
                                        0x370,  0x3FF,   // Greek
                                        0x2010, 0x2027,  // dashes, ellipsis
                                        0x2070, 0x209F,  // superscripts and subscripts
                                        0x2200, 0x22FF,  // mathematical signs
                                        0};
  const std::filesystem::path file = std::filesystem::path("/usr/share/fonts/truetype/dejavu") / name;
  if (!std::filesystem::exists(file)) {
    throw MissingError("no font at " + file.string() + "; on Debian: apt-get install fonts-dejavu-core");
  }
  ImFontConfig config;
  config.OversampleH = 2;
  config.PixelSnapH = true;
  return ImGui::GetIO().Fonts->AddFontFromFileTTF(file.c_str(), pixels, &config, kRanges);
}

}  // namespace

Fonts loadFonts(float pixels) {
  return {load("DejaVuSans.ttf", pixels), load("DejaVuSans-Bold.ttf", pixels),
          load("DejaVuSansMono.ttf", pixels)};
}

}  // namespace migiwa
