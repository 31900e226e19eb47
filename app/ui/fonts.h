// The fonts of panels and pictures: DejaVu Sans, with the Greek and the signs that formulas need.
#pragma once

#include <imgui.h>

namespace migiwa {

struct Fonts {
  ImFont* regular = nullptr;
  ImFont* bold = nullptr;
  ImFont* mono = nullptr;
};

/// Adds them to the current ImGui context's atlas. Throws MissingError with the package to install.
Fonts loadFonts(float pixels);

}  // namespace migiwa
