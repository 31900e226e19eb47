// The two passes of an iteration written plainly, one pair at a time with exact square roots: what the
// vectorised passes are compared with, in result and in time. For Poly6 with Spiky's pair gradients and the
// full gradient step.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/solver/state.h"
#include "core/sph/kernels.h"

namespace migiwa::testing {

/// Neighbours as indices, one list after the other.
struct IndexLists {
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> neighbour;

  explicit IndexLists(const StepState& state) {
    start.push_back(0);
    for (std::size_t i = 0; i < state.particles.size(); ++i) {
      for (const std::uint32_t j : state.neighbours.of(i)) neighbour.push_back(j);
      start.push_back(neighbour.size());
    }
  }
};

struct ScalarResult {
  std::vector<float> density, lambda;
  std::vector<Vec3f> moved;  ///< (m)
};

inline void scalarLambda(const StepState& state, const IndexLists& lists, ScalarResult& out) {
  const float h = state.supportRadius, mass = state.lattice.massRatio;
  const float epsilon = static_cast<float>(state.parameters.cfmEpsilon) * state.lattice.squaredGradients;
  const std::size_t n = state.particles.size();
  out.density.assign(n, 0), out.lambda.assign(n, 0);
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f at = state.current[i].xyz();
      float covered = Poly6::value(0), squaredSlopes = 0;
      Vec3f gradient = Vec3f::Zero();
      for (std::size_t k = lists.start[i]; k < lists.start[i + 1]; ++k) {
        const Vec3f offset = (at - state.current[lists.neighbour[k]].xyz()) / h;
        const float q = offset.norm(), slope = Spiky::derivative(q);
        covered += Poly6::value(q);
        gradient += slope / q * offset;
        squaredSlopes += slope * slope;
      }
      const float gamma = state.gamma[i], density = mass * covered / gamma;
      gradient *= mass;
      if (state.wallSlot[i] != FluidState::kNoWall)
        gradient -= density * state.wallSlots[state.wallSlot[i]].sample.pairGradient;
      const float squared = (gradient.squaredNorm() + mass * mass * squaredSlopes) / (gamma * gamma);
      out.density[i] = density;
      out.lambda[i] = -std::max(density - 1, 0.0F) / (squared + epsilon);
    }
  });
}

inline void scalarMove(const StepState& state, const IndexLists& lists, ScalarResult& out) {
  const float h = state.supportRadius, mass = state.lattice.massRatio;
  const std::size_t n = state.particles.size();
  out.moved.assign(n, Vec3f::Zero());
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f at = state.current[i].xyz();
      const float own = out.lambda[i] / state.gamma[i];
      Vec3f move = Vec3f::Zero();
      for (std::size_t k = lists.start[i]; k < lists.start[i + 1]; ++k) {
        const std::uint32_t j = lists.neighbour[k];
        const Vec3f offset = (at - state.current[j].xyz()) / h;
        const float q = offset.norm();
        move += (own + out.lambda[j] / state.gamma[j]) * Spiky::derivative(q) / q * offset;
      }
      move *= mass;
      if (state.wallSlot[i] != FluidState::kNoWall)
        move -= own * out.density[i] * state.wallSlots[state.wallSlot[i]].sample.pairGradient;
      out.moved[i] = at + h * move;
    }
  });
}

/// Both passes of a first iteration, with all pairs of the state's lists.
inline ScalarResult scalarIteration(const StepState& state) {
  const IndexLists lists(state);
  ScalarResult result;
  scalarLambda(state, lists, result);
  scalarMove(state, lists, result);
  return result;
}

}  // namespace migiwa::testing
