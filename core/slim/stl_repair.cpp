#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>

#include "core/slim/shape_import.h"
#include "core/slim/text_lines.h"

namespace migiwa {

namespace {

constexpr std::size_t kHeader = 84, kTriangle = 50;  ///< bytes of a binary file

std::string lowered(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::size_t saidOf(std::string_view content) {
  std::uint32_t said = 0;
  for (std::size_t k = 4; k-- > 0;) said = said << 8U | static_cast<unsigned char>(content[kHeader - 4 + k]);
  return said;
}

/// Text begins with "solid", and so do some binary files.
bool isText(std::string_view content) {
  const std::size_t begin = std::min(content.find_first_not_of(" \t\r\n"), content.size());
  if (lowered(content.substr(begin, 5)) != "solid") return false;
  if (content.size() >= kHeader && content.size() == kHeader + kTriangle * saidOf(content)) return false;
  return content.substr(0, 512).find('\0') == content.npos;
}

/// What is wrong with a text, in which keywords are in small letters.
std::string textFault(std::string_view content) {
  TextLines lines(content);
  std::size_t facets = 0, corners = 0;
  bool within = false;
  const auto wrongCorners = [&](const std::string& where) {
    return "expected 3 corners in facet " + std::to_string(facets) + ", found " + std::to_string(corners) +
           where + "; export the file anew";
  };
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word == "facet") {
      if (within) return wrongCorners(" before the next one in " + lines.place());
      ++facets, corners = 0, within = true;
    } else if (word == "vertex") {
      ++corners;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string_view number = lines.word();
        double ignored = 0;
        if (!isNumber(number, ignored))
          return "expected the 3 coordinates of a corner in " + lines.place() + ", found \"" +
                 std::string(number) + '"';
      }
    } else if (word == "endfacet") {
      if (corners != 3) return wrongCorners(" in " + lines.place());
      within = false;
    }
  }
  return within ? wrongCorners(": the file ends there") : std::string();
}

std::string repairBinary(std::string& content, std::vector<std::string>& notes) {
  if (content.size() < kHeader)
    return "expected an STL file, as text that begins with \"solid\" or at least " + std::to_string(kHeader) +
           " bytes, found " + std::to_string(content.size());
  const std::size_t said = saidOf(content), held = (content.size() - kHeader) / kTriangle,
                    rest = (content.size() - kHeader) % kTriangle;
  const std::string counts = std::to_string(said) + " triangles, as its header says, found ";
  if (said > held && rest > 0)
    return "expected " + counts + std::to_string(held) + " and " + std::to_string(rest) +
           " bytes more: the file is cut off; copy or export it anew";
  if (said == 0 && rest > 0)
    return "expected triangles, found a header that says 0 of them and " +
           std::to_string(content.size() - kHeader) + " bytes, which is no multiple of " +
           std::to_string(kTriangle) + "; export the file anew";
  if (rest == 0 && said != held && held <= std::numeric_limits<std::uint32_t>::max()) {
    notes.push_back("its header says " + std::to_string(said) + " triangles and the file holds " +
                    std::to_string(held) + "; all of those were taken");
    for (std::size_t k = 0; k < 4; ++k) content[kHeader - 4 + k] = static_cast<char>(held >> (8 * k) & 0xFFU);
  } else if (rest > 0) {
    notes.push_back(std::to_string(content.size() - kHeader - said * kTriangle) +
                    " bytes after the last of " + std::to_string(said) + " triangles were left out");
    content.resize(kHeader + said * kTriangle);
  }
  return {};
}

}  // namespace

std::string repairStl(std::string& content, std::vector<std::string>& notes) {
  if (!isText(content)) return repairBinary(content, notes);
  if (content.find("facet") == content.npos || !content.starts_with("solid")) {
    content = lowered(content);
    content.erase(0, content.find("solid"));
  }
  return textFault(content);
}

}  // namespace migiwa
