#include "tests/render/shown_text.h"

#include <imgui.h>

namespace migiwa {

std::string clipboardText() {
  const char* const text = ImGui::GetClipboardText();
  return text != nullptr ? text : "";
}

}  // namespace migiwa
