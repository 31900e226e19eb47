#include "core/base/guard.h"
#include "core/solver/stages.h"

namespace migiwa::stages {

namespace {

/// Sorts through `spare`, which ends up with the values in their old order.
template <class T>
void reorder(std::vector<T>& values, std::vector<T>& spare, const std::vector<std::uint32_t>& order,
             ThreadPool& pool) {
  resizeTight(spare, values.size());
  parallelFor(pool, order.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) spare[k] = values[order[k]];
  });
  values.swap(spare);
}

}  // namespace

void searchNeighbours(StepState& state) {
  const std::size_t n = state.particles.size();
  state.grid.build(std::span(state.current).first(n), state.supportRadius, state.pool);
  if (kGuards) spreadHeaps(state);
  const std::vector<std::uint32_t>& order = state.grid.order();
  reorder(state.current, state.previous, order, state.pool);
  reorder(state.particles.position, state.previous, order, state.pool);
  reorder(state.particles.velocity, state.previous, order, state.pool);
  reorder(state.particles.id, state.spareIds, order, state.pool);
  if (state.wallSlot.size() == n) reorder(state.wallSlot, state.spareIds, order, state.pool);
  // The search has the room of a buffer that the iterations fill only afterwards.
  resizeTight(state.paired, n + NeighbourLists::kScratchExtra);
  state.neighbours.build(state.grid, std::span(state.current).first(n), state.supportRadius, state.paired,
                         state.pool);
  state.current[n] = state.neighbours.ghost();
}

}  // namespace migiwa::stages
