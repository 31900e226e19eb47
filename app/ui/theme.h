// Colours and spacings of panels and of the text on pictures.
#pragma once

#include <imgui.h>

namespace migiwa {

namespace theme {
inline constexpr ImU32 kInk = IM_COL32(24, 34, 46, 255);        ///< text on the picture
inline constexpr ImU32 kFaintInk = IM_COL32(82, 97, 114, 255);  ///< its labels
inline constexpr ImU32 kPaper = IM_COL32(250, 251, 252, 205);   ///< behind it
inline constexpr ImU32 kPaperEdge = IM_COL32(60, 75, 95, 60);
inline constexpr ImU32 kAlert = IM_COL32(255, 143, 115, 255);
inline constexpr ImU32 kAccent = IM_COL32(71, 184, 172, 255);
inline constexpr ImU32 kMotion = IM_COL32(233, 196, 106, 255);  ///< curves of what moves
inline constexpr ImU32 kWell = IM_COL32(17, 22, 29, 255);       ///< behind plots and bars
inline constexpr ImU32 kGridLine = IM_COL32(255, 255, 255, 28);
}  // namespace theme

/// Sets the current ImGui context's style for text of `pixels` height.
void applyTheme(float pixels);

}  // namespace migiwa
