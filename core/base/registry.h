// The names of a registry's entries, for the scene keys that choose among them.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace migiwa {

/// `kEntries` is an array, in static storage, of structs with a member `name`.
template <const auto& kEntries>
std::span<const std::string_view> registryNames() {
  static constexpr auto kNames = [] {
    std::array<std::string_view, kEntries.size()> names;
    for (std::size_t k = 0; k < names.size(); ++k) names[k] = kEntries[k].name;
    return names;
  }();
  return kNames;
}

}  // namespace migiwa
