#include "core/slim/cell_hash.h"

#include <bit>

namespace migiwa {

void CellHash::build(const std::vector<std::uint64_t>& sortedKeys) {
  cells_ = 0;
  for (std::size_t k = 0; k < sortedKeys.size(); ++k)
    if (k == 0 || sortedKeys[k] != sortedKeys[k - 1]) ++cells_;
  // At most half full: a search ends after a step or two.
  slots_.assign(cells_ == 0 ? 0 : std::bit_ceil(2 * cells_), {});
  if (slots_.empty()) return;
  mask_ = slots_.size() - 1;
  for (std::size_t begin = 0; begin < sortedKeys.size();) {
    std::size_t end = begin;
    while (end < sortedKeys.size() && sortedKeys[end] == sortedKeys[begin]) ++end;
    std::size_t slot = hash(sortedKeys[begin]) & mask_;
    while (slots_[slot].key != kEmpty) slot = (slot + 1) & mask_;
    slots_[slot] = {sortedKeys[begin], {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}};
    begin = end;
  }
}

}  // namespace migiwa
