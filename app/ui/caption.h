// The lines in a corner of every picture: what it shows, and when.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/render/projection.h"

namespace migiwa {

struct Fonts;

struct Caption {
  std::string title;
  std::vector<std::pair<std::string, std::string>> rows;  ///< label and value
};

/// Draws it in the top left corner of `area`.
void drawCaption(const Caption& caption, const Rect& area, const Fonts& fonts);

}  // namespace migiwa
