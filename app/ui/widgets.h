// Small pieces that the panels share.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

namespace migiwa {

/// A scene key as a label: "surface_tension" is "Surface tension".
std::string titleOf(std::string_view key);
/// A label in the left column; the next widget fills the right one.
void rowLabel(const char* label);
/// A drop-down list over names; returns whether `index` changed. It may begin beyond them.
bool choice(const char* id, int& index, std::span<const std::string_view> names);
/// What sliders of numbers have that span powers of ten.
constexpr ImGuiSliderFlags kLogSlider = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic;
bool logSlider(const char* id, double& value, double low, double high, const char* format);
/// Text in the panels' fainter colour.
void faintText(std::string_view text);
/// `count` buttons side by side: the width of each.
float buttonWidth(int count);

}  // namespace migiwa
