#include "core/scene/nearest_name.h"

#include <algorithm>

namespace migiwa {

int editDistance(std::string_view a, std::string_view b) {
  // Rows of the usual table: the distances of prefixes of a to all prefixes of b. A swap looks two rows back.
  std::vector<int> before(b.size() + 1);
  std::vector<int> above(b.size() + 1);
  std::vector<int> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = static_cast<int>(k);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, above);
    std::swap(above, row);
    row[0] = static_cast<int>(i);
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const int replaced = above[k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1);
      row[k] = std::min({replaced, above[k] + 1, row[k - 1] + 1});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        row[k] = std::min(row[k], before[k - 2] + 1);
    }
  }
  return row.back();
}

std::string_view nearestName(std::string_view word, std::span<const std::string_view> names) {
  // No name is longer than this: the rest of a longer word changes nothing in which one is nearest.
  constexpr std::size_t kEnough = 100;
  std::string_view best;
  int least = 0;
  for (const std::string_view name : names) {
    const int distance = editDistance(word.substr(0, kEnough), name);
    if (best.empty() || distance < least) {
      best = name;
      least = distance;
    }
  }
  return best;
}

std::string quotedList(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  return text;
}

}  // namespace migiwa
