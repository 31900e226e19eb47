// METHOD: the displacement of [FM] Eq. 10 in three forms, see PositionStep.
// Deviation: the default is the constraint's true gradient step,
//   dx_i = (m/rho0) sum_j (lambda_i/gamma_i + lambda_j/gamma_j) grad W_ij - lambda_i rho_i/(rho0 gamma_i)
//   grad gamma_i,
// whose last term is the wall pushing back; Eq. 10 as printed lets particles crowd the wall.
#include "core/solver/pair_geometry.h"
#include "core/solver/stages.h"
#include "core/sph/kernels.h"

namespace migiwa::stages {

namespace {

template <class Kernel>
void positionPass(StepState& state) {
  const float inverseSupport = 1 / state.supportRadius;
  const bool wallPush = state.parameters.positionStep != PositionStep::paper;
  parallelFor(state.pool, state.current.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Float4 at = state.current[i];
      Vec3f move = Vec3f::Zero();
      for (const std::uint32_t j : state.neighbours.of(i)) {
        const Float4 other = state.current[j];
        const float factor = at.w + other.w;
        if (factor == 0) continue;
        const PairGeometry pair =
            pairGeometry(at, other, inverseSupport, state.particles.id[i], state.particles.id[j]);
        move += factor * PairKernel<Kernel>::derivative(pair.q) * pair.direction;
      }
      move *= state.lattice.massRatio;
      if (const std::uint32_t slot = state.wallSlot[i]; wallPush && slot != StepState::kNoWall)
        move -=
            state.lambda[i] * state.density[i] / state.gamma[i] * state.wallSlots[slot].sample.pairGradient;
      state.next[i] = Float4(at.xyz() + state.supportRadius * move, at.w);
    }
  });
}

}  // namespace

void movePositions(StepState& state) {
  state.next.resize(state.current.size());
  withKernel(state.parameters.kernel, [&](auto kernel) { positionPass<decltype(kernel)>(state); });
  state.current.swap(state.next);
}

}  // namespace migiwa::stages
