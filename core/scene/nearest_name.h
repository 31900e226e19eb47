// The known name that somebody probably meant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

/// Letters to insert, delete, replace or swap with their neighbour to get from one word to the other.
int editDistance(std::string_view a, std::string_view b);

/// The name with the smallest edit distance, the first of equals; empty without names.
std::string_view nearestName(std::string_view word, std::span<const std::string_view> names);

/// `"a", "b", "c"`.
std::string quotedList(std::span<const std::string_view> names);

}  // namespace migiwa
