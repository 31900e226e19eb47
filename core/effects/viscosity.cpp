// XSPH (Schechter & Bridson 2012, Macklin & Mueller 2013): each velocity moves towards the kernel-weighted
// mean of its neighbours', v_i += c sum_j (m/rho0) (v_j - v_i) W_ij. Deviation: the rest density in place of
// rho_j makes the pairs symmetric, so momentum is conserved exactly.
#include <array>

#include "core/effects/effects.h"
#include "core/solver/pair_geometry.h"
#include "core/solver/step_state.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

class Viscosity final : public Effect {
 public:
  void describe(FieldVisitor& visitor) override {
    visitor.number("xsph", xsph_, Range::closed(0, 1),
                   {"1", "Part of the velocity difference to the neighbours that a step takes away."});
  }

  void apply(StepState& state) const override {
    std::vector<Float4> smoothed(state.particles.size());
    withKernel(state.parameters.kernel, [&](auto kernel) {
      using Kernel = decltype(kernel);
      const float scale = static_cast<float>(xsph_) * state.lattice.massRatio;
      const float inverseSupport = 1 / state.supportRadius;
      const std::vector<Float4>& position = state.particles.position;
      const std::vector<Float4>& velocity = state.particles.velocity;
      parallelFor(state.pool, smoothed.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3f at = position[i].xyz(), own = velocity[i].xyz();
          Vec3f sum = Vec3f::Zero();
          for (const std::uint32_t j : state.neighbours.of(i)) {
            const float q = (at - position[j].xyz()).norm() * inverseSupport;
            sum += Kernel::value(q) * (velocity[j].xyz() - own);
          }
          smoothed[i] = Float4(own + scale * sum);
        }
      });
    });
    state.particles.velocity.swap(smoothed);
  }

 private:
  double xsph_ = 0.05;
};

}  // namespace

std::unique_ptr<Effect> makeViscosity() {
  return std::make_unique<Viscosity>();
}

}  // namespace migiwa
