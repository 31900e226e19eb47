#include "core/solver/stages.h"

namespace migiwa::stages {

namespace {

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order, ThreadPool& pool) {
  std::vector<T> sorted(values.size());
  parallelFor(pool, values.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) sorted[k] = values[order[k]];
  });
  values.swap(sorted);
}

}  // namespace

void searchNeighbours(StepState& state) {
  state.grid.build(state.current, state.supportRadius, state.pool);
  const std::vector<std::uint32_t>& order = state.grid.order();
  reorder(state.current, order, state.pool);
  reorder(state.particles.position, order, state.pool);
  reorder(state.particles.velocity, order, state.pool);
  reorder(state.particles.id, order, state.pool);
  state.neighbours.build(state.grid, state.current, state.supportRadius, state.pool);
}

}  // namespace migiwa::stages
