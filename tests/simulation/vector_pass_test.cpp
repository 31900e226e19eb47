// The vectorised passes against plain code, pair by pair, on every instruction set that this processor has.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/solver/effect.h"
#include "core/solver/state.h"
#include "core/solver/step.h"
#include "tests/support/dense_tank.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/scalar_passes.h"
#include "tests/support/test_effects.h"

namespace migiwa {
namespace vector_pass_test {

using testing::DenseTank;
using testing::onEveryTarget;

TEST(VectorPasses, ThereAreWidthsToCompare) {
  EXPECT_GE(hwy::SupportedAndGeneratedTargets().size(), 2U);
}

TEST(VectorPasses, AnIterationIsThatOfPlainCode) {
  onEveryTarget([] {
    DenseTank tank(2000, 1);
    tank.prepare();
    StepState& state = tank.state();
    const testing::ScalarResult plain = testing::scalarIteration(state);
    const IterationError error = stages::computeLambda(state);
    stages::movePositions(state);
    double sum = 0;
    for (std::size_t i = 0; i < plain.moved.size(); ++i) {
      ASSERT_NEAR(state.density[i], plain.density[i], 1e-5F * plain.density[i]);
      ASSERT_NEAR(state.lambda[i], plain.lambda[i], 1e-5F);
      ASSERT_LT((state.current[i].xyz() - plain.moved[i]).norm(), 1e-5F * state.supportRadius);
      sum += std::max(static_cast<double>(plain.density[i]) - 1, 0.0);
    }
    EXPECT_GT(error.mean, 1e-3) << "the lattice is pushed out of its places";
    EXPECT_NEAR(error.mean, sum / static_cast<double>(plain.moved.size()), 1e-6);
  });
}

/// Positions and velocities by id after a step.
std::vector<std::pair<Vec3f, Vec3f>> afterAStep() {
  DenseTank tank(2000, 1);
  StepState& state = tank.state();
  // The number of iterations must not hang on rounding.
  state.parameters.minIterations = state.parameters.maxIterations = 4;
  EffectPipeline effects({{"viscosity", std::shared_ptr<const Effect>(makeEffect(0))}});
  advanceStep(state, effects);
  std::vector<std::pair<Vec3f, Vec3f>> result(state.particles.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[state.particles.id[i]] = {state.particles.position[i].xyz(), state.particles.velocity[i].xyz()};
  return result;
}

TEST(VectorPasses, AStepIsTheSameWithinRoundingOnEveryInstructionSet) {
  const auto reference = afterAStep();
  onEveryTarget([&] {
    const auto other = afterAStep();
    for (std::size_t i = 0; i < reference.size(); ++i) {
      // Relative to a coordinate, and to the speed that a whole spacing a step would be.
      ASSERT_LT((other[i].first - reference[i].first).norm(), 1e-5F * reference[i].first.norm());
      ASSERT_LT((other[i].second - reference[i].second).norm(), 1e-3F * DenseTank::kSpacing / 0.005F);
    }
  });
}

TEST(VectorPasses, EveryKernelsVectorIsTheKernel) {
  for (const KernelType kernel :
       {KernelType::poly6, KernelType::spiky, KernelType::cubicSpline, KernelType::wendlandC2}) {
    onEveryTarget([kernel] {
      DenseTank tank(500, 1);
      StepState& state = tank.state();
      state.parameters.kernel = kernel;
      state.lattice = restingLattice(kernel, state.parameters.supportRatio);
      tank.prepare();
      withKernel(kernel, [&](auto density) {
        using Kernel = decltype(density);
        for (std::size_t i = 0; i < state.particles.size(); ++i) {
          float covered = Kernel::value(0);
          for (const std::uint32_t j : state.neighbours.of(i))
            covered +=
                Kernel::value((state.current[i].xyz() - state.current[j].xyz()).norm() / state.supportRadius);
          const float expected = state.lattice.massRatio * covered / state.gamma[i];
          ASSERT_NEAR(state.density[i], expected, 2e-5F * expected);
        }
      });
    });
  }
}

/// A tank with two of the particles in its middle on one point.
class TankWithACoincidentPair {
 public:
  static constexpr std::uint32_t kOne = 220, kOther = 221;

  explicit TankWithACoincidentPair(KernelType kernel) : tank_(500, 1) {
    StepState& state = tank_.state();
    state.parameters.kernel = kernel;
    state.lattice = restingLattice(kernel, state.parameters.supportRatio);
    state.particles.position[kOther] = state.particles.position[kOne];
    tank_.prepare();
  }
  StepState& state() { return tank_.state(); }
  Vec3f current(std::uint32_t id) {
    const std::vector<std::uint32_t>& ids = state().particles.id;
    return state()
        .current[static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin())]
        .xyz();
  }

 private:
  DenseTank tank_;
};

TEST(VectorPasses, APairOnOnePointPartsInTheDirectionOfItsIds) {
  // Of the others the slope is zero at distance zero.
  for (const KernelType kernel : {KernelType::poly6, KernelType::spiky}) {
    onEveryTarget([kernel] {
      TankWithACoincidentPair tank(kernel);
      StepState& state = tank.state();
      ASSERT_EQ(tank.current(tank.kOne), tank.current(tank.kOther));
      state.metCoincident = false;
      stages::computeLambda(state);
      stages::movePositions(state);
      EXPECT_TRUE(state.metCoincident);
      // All else pushes both alike.
      const Vec3f apart = tank.current(tank.kOne) - tank.current(tank.kOther);
      EXPECT_GT(apart.norm(), 1e-3F * DenseTank::kSpacing);
      EXPECT_GT(apart.normalized().dot(coincidentDirection(tank.kOne, tank.kOther)), 0.999F);
    });
  }
}

TEST(VectorPasses, APairOnOnePointLeavesEveryKernelAndEffectFinite) {
  for (const KernelType kernel :
       {KernelType::poly6, KernelType::spiky, KernelType::cubicSpline, KernelType::wendlandC2}) {
    onEveryTarget([kernel] {
      TankWithACoincidentPair tank(kernel);
      EffectPipeline effects(testing::effectsOf(
          R"({"viscosity": {"kinematic": 0.001}, "vorticity_confinement": {},
              "surface_tension": {"coefficient": 1}, "artificial_pressure": {}})"));
      EXPECT_FALSE(advanceStep(tank.state(), effects).any());
    });
  }
}

}  // namespace vector_pass_test
}  // namespace migiwa
