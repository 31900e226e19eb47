#include "tests/render/shown_text.h"

#include <array>
#include <map>
#include <vector>

#include <imgui.h>

namespace migiwa {
namespace {

/// Where a letter lies in the fonts' texture: its upper left and lower right corner.
using Place = std::array<float, 4>;

std::map<Place, char> letters() {
  std::map<Place, char> result;
  for (const ImFont* font : ImGui::GetIO().Fonts->Fonts)
    for (const ImFontGlyph& glyph : font->Glyphs)
      if (glyph.Visible != 0)
        result[{glyph.U0, glyph.V0, glyph.U1, glyph.V1}] =
            glyph.Codepoint < 128 ? static_cast<char>(glyph.Codepoint) : '?';
  return result;
}

/// The text, and of each letter the middle (pixels).
struct Shown {
  std::string text;
  std::vector<std::array<float, 2>> places;
  void add(char letter, float x, float y) {
    text += letter;
    places.push_back({x, y});
  }
};

Shown shown() {
  // A space is wider.
  const float adjoining = 0.2F * ImGui::GetIO().Fonts->Fonts.front()->FontSize;
  const std::map<Place, char> known = letters();
  Shown all;
  const ImDrawData& drawn = *ImGui::GetDrawData();
  for (int list = 0; list < drawn.CmdListsCount; ++list) {
    const ImVector<ImDrawVert>& corners = drawn.CmdLists[list]->VtxBuffer;
    ImVec2 end{-1e9F, 0};
    for (int k = 0; k + 3 < corners.Size; ++k) {
      const ImDrawVert &first = corners[k], &last = corners[k + 2];
      const auto letter = known.find({first.uv.x, first.uv.y, last.uv.x, last.uv.y});
      if (letter == known.end()) continue;
      const float gap = first.pos.x - end.x;
      const bool sameLine = first.pos.y < end.y;
      const float x = 0.5F * (first.pos.x + last.pos.x), y = 0.5F * (first.pos.y + last.pos.y);
      if (!sameLine || gap < -adjoining || gap > adjoining) all.add(' ', x, y);
      all.add(letter->second, x, y);
      end = last.pos;
      k += 3;
    }
    all.add(' ', end.x, end.y);
  }
  return all;
}

}  // namespace

std::string shownText() {
  return shown().text;
}

std::optional<std::array<float, 2>> placeOfText(const std::string& word) {
  const Shown all = shown();
  const std::size_t at = all.text.find(' ' + word + ' ');
  if (at == std::string::npos) return std::nullopt;
  return all.places[at + 1 + word.size() / 2];
}

}  // namespace migiwa
