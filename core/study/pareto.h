// The Pareto front: what cannot be had more exactly for less.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace migiwa {

struct CostAndError {
  std::optional<double> cost, error;  ///< both: less is better; null: takes no part
};

/// Indices of the points that no other beats: none is as good in both and better in one. By rising cost.
/// Points that are the same in both are on the front together or not at all.
std::vector<std::size_t> paretoFront(const std::vector<CostAndError>& points);

}  // namespace migiwa
