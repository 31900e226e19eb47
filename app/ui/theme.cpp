#include "app/ui/theme.h"

#include <cmath>

namespace migiwa {

void applyTheme(float pixels) {
  const auto part = [pixels](float share) { return std::round(share * pixels); };
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  style.WindowPadding = {part(0.75F), part(0.5F)};
  style.FramePadding = {part(0.4F), part(0.16F)};
  style.ItemSpacing = {part(0.4F), part(0.27F)};
  style.ItemInnerSpacing = {part(0.35F), part(0.25F)};
  style.ScrollbarSize = part(0.7F);
  style.GrabMinSize = part(0.6F);
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.PopupRounding = 4;
  style.ScrollbarRounding = 4;
  style.AntiAliasedLinesUseTex = false;

  const auto set = [&style](ImGuiCol which, float r, float g, float b, float a = 1) {
    style.Colors[which] = {r, g, b, a};
  };
  set(ImGuiCol_Text, 0.90F, 0.92F, 0.94F);
  set(ImGuiCol_TextDisabled, 0.52F, 0.57F, 0.63F);
  set(ImGuiCol_WindowBg, 0.115F, 0.135F, 0.165F);
  set(ImGuiCol_PopupBg, 0.090F, 0.108F, 0.135F, 0.98F);
  set(ImGuiCol_Border, 1, 1, 1, 0.10F);
  set(ImGuiCol_FrameBg, 0.200F, 0.230F, 0.275F);
  set(ImGuiCol_FrameBgHovered, 0.245F, 0.285F, 0.340F);
  set(ImGuiCol_FrameBgActive, 0.275F, 0.325F, 0.390F);
  set(ImGuiCol_ScrollbarBg, 0, 0, 0, 0.20F);
  set(ImGuiCol_ScrollbarGrab, 1, 1, 1, 0.18F);
  set(ImGuiCol_ScrollbarGrabHovered, 1, 1, 1, 0.28F);
  set(ImGuiCol_ScrollbarGrabActive, 1, 1, 1, 0.38F);
  set(ImGuiCol_CheckMark, 0.33F, 0.82F, 0.76F);
  set(ImGuiCol_SliderGrab, 0.25F, 0.62F, 0.60F, 0.65F);
  set(ImGuiCol_SliderGrabActive, 0.33F, 0.78F, 0.74F, 0.75F);
  set(ImGuiCol_Button, 0.165F, 0.375F, 0.400F);
  set(ImGuiCol_ButtonHovered, 0.200F, 0.465F, 0.490F);
  set(ImGuiCol_ButtonActive, 0.235F, 0.560F, 0.580F);
  set(ImGuiCol_Header, 0.155F, 0.185F, 0.225F);
  set(ImGuiCol_HeaderHovered, 0.205F, 0.245F, 0.300F);
  set(ImGuiCol_HeaderActive, 0.235F, 0.285F, 0.350F);
  set(ImGuiCol_Separator, 1, 1, 1, 0.10F);
  set(ImGuiCol_NavHighlight, 0.33F, 0.82F, 0.76F);
}

}  // namespace migiwa
