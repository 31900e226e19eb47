// METHOD: density [FM] Eq. 5, constraint Eq. 9, its gradients Eqs. 12 and 13 and lambda Eq. 11. Gradients are
// taken from the pair kernel, as in Macklin & Mueller 2013, gamma's included. Deviation: the constraint is
// clamped at zero, for the paper is silent on free surfaces and fluid clumps otherwise.
#include <algorithm>
#include <cmath>

#include "core/solver/pair_geometry.h"
#include "core/solver/stages.h"
#include "core/sph/kernels.h"

namespace migiwa::stages {

namespace {

template <class Kernel>
IterationError lambdaPass(StepState& state) {
  const std::size_t n = state.current.size();
  const float inverseSupport = 1 / state.supportRadius;
  const float massRatio = state.lattice.massRatio;
  const float epsilon = static_cast<float>(state.parameters.cfmEpsilon) * state.lattice.squaredGradients;
  const bool divideByGamma = state.parameters.positionStep == PositionStep::gradient;
  struct Error {
    double sum = 0;
    float max = 0;
  };
  const Error error = parallelReduce(
      state.pool, n, Error{},
      [&](std::size_t begin, std::size_t end) {
        Error part;
        for (std::size_t i = begin; i < end; ++i) {
          const Float4 at = state.current[i];
          float covered = Kernel::value(0);
          float squaredSlopes = 0;
          Vec3f gradient = Vec3f::Zero();
          for (const std::uint32_t j : state.neighbours.of(i)) {
            const PairGeometry pair = pairGeometry(at, state.current[j], inverseSupport,
                                                   state.particles.id[i], state.particles.id[j]);
            covered += Kernel::value(pair.q);
            const float slope = PairKernel<Kernel>::derivative(pair.q);
            gradient += slope * pair.direction;
            squaredSlopes += slope * slope;
          }
          const float gamma = state.gamma[i];
          const float density = massRatio * covered / gamma;
          gradient *= massRatio;
          if (const std::uint32_t slot = state.wallSlot[i]; slot != StepState::kNoWall)
            gradient -= density * state.wallSlots[slot].sample.pairGradient;
          const float inverseGamma = 1 / gamma;
          const float squaredGradients =
              (gradient.squaredNorm() + massRatio * massRatio * squaredSlopes) * inverseGamma * inverseGamma;
          const float constraint = std::max(density - 1, 0.0F);
          const float lambda = -constraint / (squaredGradients + epsilon);
          state.density[i] = density;
          state.lambda[i] = lambda;
          state.current[i].w = divideByGamma ? lambda * inverseGamma : lambda;
          part.sum += static_cast<double>(constraint);
          part.max = std::max(part.max, constraint);
        }
        return part;
      },
      [](Error a, const Error& b) {
        return Error{a.sum + b.sum, std::max(a.max, b.max)};
      });
  return {n > 0 ? error.sum / static_cast<double>(n) : 0, static_cast<double>(error.max)};
}

}  // namespace

IterationError computeLambda(StepState& state) {
  state.density.resize(state.current.size());
  state.lambda.resize(state.current.size());
  return withKernel(state.parameters.kernel,
                    [&](auto kernel) { return lambdaPass<decltype(kernel)>(state); });
}

}  // namespace migiwa::stages
