#include "core/simulation/spacing_histogram.h"

#include <cmath>
#include <numeric>

namespace migiwa {

void SpacingHistogram::add(float distance) {
  // A neighbour is within the support radius; beyond it, all are as far.
  constexpr float kFarthest = 1000;
  const auto bin =
      static_cast<std::size_t>(std::lround(std::fmin(distance, kFarthest) * static_cast<float>(kBins)));
  if (bin >= counts_.size()) counts_.resize(bin + 1, 0);
  ++counts_[bin];
}

double SpacingHistogram::atRank(std::uint64_t rank) const {
  std::uint64_t seen = 0;
  std::size_t bin = 0;
  while (seen + counts_[bin] <= rank) seen += counts_[bin++];
  return static_cast<double>(bin) / kBins;
}

std::optional<double> SpacingHistogram::firstPercentile() const {
  const std::uint64_t total = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
  if (total == 0) return std::nullopt;
  const double place = 0.01 * static_cast<double>(total - 1);
  const auto low = static_cast<std::uint64_t>(place);
  const double a = atRank(low);
  if (low + 1 == total) return a;
  return a + (place - static_cast<double>(low)) * (atRank(low + 1) - a);
}

void SpacingHistogram::visit(StateVisitor& visitor, const std::string& name) {
  std::vector<std::uint32_t> bins;
  std::vector<std::uint64_t> counts;
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    if (counts_[bin] == 0) continue;
    bins.push_back(static_cast<std::uint32_t>(bin));
    counts.push_back(counts_[bin]);
  }
  visitor.array(name + "/bins", bins);
  visitor.array(name + "/counts", counts);
  if (!visitor.reading()) return;
  constexpr std::uint32_t kMost = 1000 * kBins;
  if (bins.size() != counts.size() || (!bins.empty() && bins.back() > kMost))
    throw StateError("a count for every bin of " + name + ", found something else");
  counts_.assign(bins.empty() ? 0 : std::size_t{bins.back()} + 1, 0);
  for (std::size_t k = 0; k < bins.size(); ++k) counts_.at(bins[k]) = counts[k];
}

}  // namespace migiwa
