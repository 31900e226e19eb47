// Ends that a run cannot reach are refused, with an end or a step that would do, which does.
#include <limits>

#include <gtest/gtest.h>

#include "core/scene/scene.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace run_limit_test {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The number that follows `lead` in a text.
double numberAfter(const std::string& text, const std::string& lead) {
  const std::size_t at = text.find(lead);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0 : std::stod(text.substr(at + lead.size()));
}

Scene faucet() {
  return parseScene(R"({ "format": 1, "particle_spacing": 0.01, "duration": 1,
      "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.1, 0.1, 0.1] } ],
      "emitters": [ { "shape": "disc", "center": [0, 1, 0], "radius": 0.1, "direction": [0, -1, 0], "speed": 1,
                      "start": 2, "particles": 2000000000 } ] })",
                    "faucet.json");
}

TEST(RunLimit, AStepThatTheRemedyNamesIsLongEnough) {
  for (const double step : {1e-9, 3.3e-9, 7.7e-8})
    for (const int substeps : {1, 7, 1000}) {
      SolverParameters solver;
      solver.timeStep = step, solver.substeps = substeps;
      const auto fault = tooShortStep(solver, 12345);
      ASSERT_TRUE(fault.has_value()) << step;
      solver.timeStep = numberAfter(*fault, "expected at least ");
      EXPECT_GT(solver.timeStep, step);
      EXPECT_FALSE(tooShortStep(solver, 12345).has_value()) << *fault;
    }
}

TEST(RunLimit, AQuotientThatOverflowsIsTooMuch) {
  SolverParameters solver;
  solver.timeStep = 1e-300;
  EXPECT_TRUE(tooShortStep(solver, 1e300).has_value());
  Scene scene = faucet();
  scene.solver.timeStep = std::numeric_limits<double>::denorm_min();
  EXPECT_TRUE(tooLateAnEnd(scene, 1, kUnlimited).has_value());
}

TEST(RunLimit, AnEndWithTooManyStepsIsRefusedWithOneThatHasNot) {
  Scene scene = faucet();
  scene.solver.timeStep = 3e-7;
  const auto fault = tooLateAnEnd(scene, 1e6, kUnlimited);
  ASSERT_TRUE(fault.has_value());
  const double remedy = numberAfter(*fault, "expected at most ");
  EXPECT_GT(remedy, 250);
  EXPECT_FALSE(tooLateAnEnd(scene, remedy, kUnlimited).has_value()) << *fault;
}

TEST(RunLimit, EmittersAreCountedToTheEndOfTheRunNotOfTheScene) {
  const Scene scene = faucet();
  EXPECT_EQ(particleCount(scene), 1000) << "nothing is emitted within the duration";
  const double memory = 1e5 * kBytesPerParticle;
  EXPECT_FALSE(tooLateAnEnd(scene, 2, memory).has_value());
  const auto fault = tooLateAnEnd(scene, 100, memory);
  ASSERT_TRUE(fault.has_value());
  EXPECT_NE(fault->find("at most 100000 particles, found 100 s"), std::string::npos) << *fault;
  const double remedy = numberAfter(*fault, "; an end of ");
  EXPECT_GT(remedy, 4);
  EXPECT_FALSE(tooLateAnEnd(scene, remedy, memory).has_value()) << *fault;
  // What a drain takes again is not there at once; an emitter ends where memory does.
  Scene drained = scene;
  drained.drains.emplace_back();
  EXPECT_FALSE(tooLateAnEnd(drained, 100, memory).has_value());
  // However much memory there is, neighbours are counted in 32 bits.
  EXPECT_TRUE(tooLateAnEnd(scene, 1e5, kUnlimited).has_value());
}

}  // namespace run_limit_test
}  // namespace migiwa
