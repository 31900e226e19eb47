#include "app/ui/shown_text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <imgui.h>

#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

/// Where a letter lies in the fonts' texture: its upper left and lower right corner.
using Place = std::array<float, 4>;

struct KnownLetter {
  char letter;
  const ImFontGlyph* glyph;
  float space;  ///< how far a space advances, in the glyph's pixels
};

std::map<Place, KnownLetter> letters() {
  std::map<Place, KnownLetter> result;
  for (const ImFont* font : ImGui::GetIO().Fonts->Fonts)
    for (const ImFontGlyph& glyph : font->Glyphs)
      if (glyph.Visible != 0)
        result[{glyph.U0, glyph.V0, glyph.U1, glyph.V1}] = {
            glyph.Codepoint < 128 ? static_cast<char>(glyph.Codepoint) : '?', &glyph,
            font->GetCharAdvance(' ')};
  return result;
}

/// The text, and of each letter the middle (pixels).
struct ShownLetters {
  std::string text;
  std::vector<std::array<float, 2>> places;
  void add(char letter, float x, float y) {
    text += letter;
    places.push_back({x, y});
  }
};

ShownLetters lettersShown() {
  const std::map<Place, KnownLetter> known = letters();
  ShownLetters all;
  const ImDrawData& drawn = *ImGui::GetDrawData();
  for (int list = 0; list < drawn.CmdListsCount; ++list) {
    const ImVector<ImDrawVert>& corners = drawn.CmdLists[list]->VtxBuffer;
    ImVec2 end{-1e9F, 0};  // where a letter that adjoins begins, and the top of its line
    for (int k = 0; k + 3 < corners.Size; ++k) {
      const ImDrawVert &first = corners[k], &last = corners[k + 2];
      const auto found = known.find({first.uv.x, first.uv.y, last.uv.x, last.uv.y});
      if (found == known.end()) continue;
      const auto& [letter, glyph, space] = found->second;
      const float scale = (last.pos.x - first.pos.x) / (glyph->X1 - glyph->X0);
      const ImVec2 begin(first.pos.x - scale * glyph->X0, first.pos.y - scale * glyph->Y0);
      const float near = 0.5F * scale * space;
      const bool adjoins = std::abs(begin.y - end.y) < near && std::abs(begin.x - end.x) < near;
      const float x = 0.5F * (first.pos.x + last.pos.x), y = 0.5F * (first.pos.y + last.pos.y);
      if (!adjoins) all.add(' ', x, y);
      all.add(letter, x, y);
      end = {begin.x + scale * glyph->AdvanceX, begin.y};
      k += 3;
    }
    all.add(' ', end.x, end.y);
  }
  return all;
}

}  // namespace

std::string shownText() {
  return lettersShown().text;
}

namespace {

bool isIn(const std::string& panel, float y) {
  const auto places = panelPlaces();
  return panel.empty() || std::any_of(places.begin(), places.end(), [&](const PanelPlace& place) {
           return place.title == panel && y >= place.top && y < place.bottom;
         });
}

}  // namespace

std::optional<std::array<float, 2>> placeOfText(const std::string& words, bool uppermost,
                                                const std::string& panel) {
  const ShownLetters all = lettersShown();
  const std::string alone = ' ' + words + ' ';
  const auto from = [&](std::size_t at) {
    return uppermost ? all.text.rfind(alone, at) : all.text.find(alone, at);
  };
  for (std::size_t at = from(uppermost ? std::string::npos : 0); at != std::string::npos;
       at = uppermost && at == 0 ? std::string::npos : from(uppermost ? at - 1 : at + 1)) {
    const std::array<float, 2> place = all.places[at + 1 + words.size() / 2];
    if (isIn(panel, place[1])) return place;
  }
  return std::nullopt;
}

std::vector<std::string> openPanels() {
  std::vector<std::string> titles;
  for (const PanelPlace& place : panelPlaces()) titles.push_back(place.title);
  return titles;
}

std::optional<std::array<float, 2>> placeOfWidget(const std::string& name, std::optional<double> share,
                                                  const std::string& panel) {
  for (const RowPlace& row : rowPlaces()) {
    if (row.label != name || (!panel.empty() && row.panel != panel)) continue;
    // A checkbox is as wide as the row is high.
    const float margin = 0.5F * row.height;
    const float x = row.x + static_cast<float>(share.value_or(0.5)) * row.width;
    return {{std::clamp(x, row.x + margin, std::max(row.x + row.width - margin, row.x + margin)),
             row.y + margin}};
  }
  return placeOfText(name, false, panel);
}

std::vector<std::string> namesLike(const std::string& name, std::size_t most) {
  std::vector<std::string> names;
  for (const RowPlace& row : rowPlaces()) names.push_back(row.label);
  std::istringstream text(shownText());
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  const auto count = static_cast<std::size_t>(1 + std::count(name.begin(), name.end(), ' '));
  for (std::size_t k = 0; k + count <= words.size(); ++k) {
    std::string phrase = words[k];
    for (std::size_t n = 1; n < count; ++n) phrase += ' ' + words[k + n];
    if (std::find(names.begin(), names.end(), phrase) == names.end()) names.push_back(std::move(phrase));
  }
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return editDistance(name, a) < editDistance(name, b);
  });
  names.resize(std::min(names.size(), most));
  return names;
}

}  // namespace migiwa
