// Distances counted rather than kept: a run of a million particles measures fifty million of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/simulation/state_visitor.h"

namespace migiwa {

class SpacingHistogram {
 public:
  /// Bins of a spacing: a percentile is off by half a bin at most.
  static constexpr int kBins = 65536;

  /// `distance` over the particle spacing, from 0 up to some support radii.
  void add(float distance);
  /// By linear interpolation between order statistics; null without distances.
  std::optional<double> firstPercentile() const;
  /// For a save; `name` of an array, such as "settled/bulk".
  void visit(StateVisitor& visitor, const std::string& name);

 private:
  /// The distance that `rank` others are not beyond.
  double atRank(std::uint64_t rank) const;

  std::vector<std::uint64_t> counts_;  ///< of each bin, up to the last that is not empty
};

}  // namespace migiwa
