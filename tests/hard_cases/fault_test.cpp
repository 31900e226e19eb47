// What is not finite is found in the step that meets it, named, and kept out of the state.
#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "core/solver/state.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace fault_test {

/// Keeps a state in memory: written by a simulation, changed by a test, and read back by it.
class Memory final : public StateVisitor {
 public:
  bool reading() const override { return reading_; }
  void number(std::string_view name, double& value) override { keep(numbers_, name, value); }
  void integer(std::string_view name, std::int64_t& value) override { keep(integers_, name, value); }
  void text(std::string_view name, std::string& value) override { keep(texts_, name, value); }
  void readBack() { reading_ = true; }

  /// Component `component` (0 to 2) of element `element` of an array of three floats each.
  void setFloat(const std::string& array, std::size_t element, std::size_t component, float value) {
    std::memcpy(&arrays_.at(array)[(3 * element + component) * sizeof(float)], &value, sizeof value);
  }
  std::uint32_t id(std::size_t element) const {
    std::uint32_t value = 0;
    std::memcpy(&value, &arrays_.at("particles/id")[element * sizeof value], sizeof value);
    return value;
  }

 protected:
  void store(std::string_view name, std::size_t, std::span<const std::byte> bytes) override {
    arrays_[std::string(name)].assign(bytes.begin(), bytes.end());
  }
  std::span<const std::byte> load(std::string_view name, std::size_t) override {
    return arrays_.at(std::string(name));
  }

 private:
  template <class Value>
  void keep(std::map<std::string, Value>& values, std::string_view name, Value& value) {
    if (reading_) value = values.at(std::string(name));
    values[std::string(name)] = value;
  }

  bool reading_ = false;
  std::map<std::string, double> numbers_;
  std::map<std::string, std::int64_t> integers_;
  std::map<std::string, std::string> texts_;
  std::map<std::string, std::vector<std::byte>> arrays_;
};

const Trouble* troubleOf(const Simulation& simulation, const std::string& kind) {
  for (const Trouble& trouble : simulation.statistics().trouble)
    if (trouble.kind == kind) return &trouble;
  return nullptr;
}

class Faults : public ::testing::TestWithParam<std::string> {};

TEST_P(Faults, AreFoundInTheStepThatMeetsThem) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    for (const int threads : {1, 3}) {
      SCOPED_TRACE(::testing::Message() << bad << ", " << threads << " threads");
      Simulation simulation(smallDamBreak(), threads);
      simulation.advanceFrame();
      simulation.advanceFrame();
      Memory memory;
      simulation.visitState(memory);
      constexpr std::size_t kPlace = 117;
      memory.setFloat(GetParam(), kPlace, 1, bad);
      memory.readBack();
      simulation.visitState(memory);
      simulation.advanceFrame();
      EXPECT_TRUE(simulation.stopped());
      EXPECT_EQ(simulation.frame(), 2) << "the frame was not made";
      const Trouble* const trouble = troubleOf(simulation, "nonfinite");
      ASSERT_NE(trouble, nullptr);
      EXPECT_EQ(trouble->step, 3);
      EXPECT_NE(trouble->detail.find("\"before the step\", particle " + std::to_string(memory.id(kPlace))),
                std::string::npos)
          << trouble->detail;
      EXPECT_EQ(simulation.statistics().nonfiniteParticles, 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Injected, Faults, ::testing::Values("particles/position", "particles/velocity"),
                         [](const auto& one) { return one.param.substr(one.param.find('/') + 1); });

/// Spoils one particle, from the given step on.
class Spoiler final : public Effect {
 public:
  enum class Where { prediction, iteration, velocity };
  Spoiler(Where where, std::uint32_t id, int step)
      : where_(where), id_(id), left_(std::make_shared<int>(step)) {}
  void describe(FieldVisitor&) override {}
  void describe(FieldWriter&) const override {}
  std::unique_ptr<Effect> clone() const override { return std::make_unique<Spoiler>(*this); }
  EffectStages stages() const override {
    return {.prediction = where_ == Where::prediction,
            .iteration = where_ == Where::iteration,
            .velocity = where_ == Where::velocity};
  }
  void changePrediction(StepState& state, std::span<EffectBuffer>) const override {
    spoil(state, state.current);
  }
  void changePositions(StepState& state, float) const override { spoil(state, state.current); }
  void changeVelocities(StepState& state, std::span<EffectBuffer>) const override {
    spoil(state, state.particles.velocity);
  }

 private:
  void spoil(const StepState& state, std::vector<Float4>& vectors) const {
    if (--*left_ > 0) return;
    for (std::size_t i = 0; i < state.particles.size(); ++i)
      if (state.particles.id[i] == id_) vectors[i].y = std::numeric_limits<float>::quiet_NaN();
  }
  Where where_;
  std::uint32_t id_;
  std::shared_ptr<int> left_;
};

class SpoiledStages : public ::testing::TestWithParam<Spoiler::Where> {};

TEST_P(SpoiledStages, AreNamedAndTheLastGoodStateStays) {
  constexpr std::uint32_t kId = 117;
  Scene scene = smallDamBreak();
  scene.solver.minIterations = scene.solver.maxIterations = 1;
  Simulation reference(scene, 1);
  for (int frame = 0; frame < 3; ++frame) reference.advanceFrame();
  // Before the scene's own effect, which hands on what it finds.
  std::vector<NamedEffect> effects{{"spoiler", std::make_shared<Spoiler>(GetParam(), kId, 4)}};
  std::copy(scene.effects.begin(), scene.effects.end(), std::back_inserter(effects));
  scene.effects = effects;
  Simulation simulation(scene, 1);
  for (int frame = 0; frame < 10; ++frame) simulation.advanceFrame();
  ASSERT_TRUE(simulation.stopped());
  EXPECT_EQ(simulation.frame(), 3);
  const Trouble* const trouble = troubleOf(simulation, "nonfinite");
  ASSERT_NE(trouble, nullptr);
  EXPECT_EQ(trouble->step, 4);
  EXPECT_NE(trouble->detail.find("1 particles are not finite after the stage \"spoiler\", particle 117"),
            std::string::npos)
      << trouble->detail;
  EXPECT_EQ(trouble->detail.find("neighbours are none"), std::string::npos) << trouble->detail;
  // The state is that of frame 3, but for the rounding of gravity's gain, taken back.
  std::map<std::uint32_t, std::size_t> places;
  const FrameView good = reference.view(), now = simulation.view();
  for (std::size_t i = 0; i < good.ids.size(); ++i) places[good.ids[i]] = i;
  for (std::size_t i = 0; i < now.ids.size(); ++i) {
    const std::size_t j = places.at(now.ids[i]);
    EXPECT_EQ(now.positions[i].xyz(), good.positions[j].xyz());
    EXPECT_LT((now.velocities[i].xyz() - good.velocities[j].xyz()).norm(), 1e-5F);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, SpoiledStages,
                         ::testing::Values(Spoiler::Where::prediction, Spoiler::Where::iteration,
                                           Spoiler::Where::velocity));

}  // namespace fault_test
}  // namespace migiwa::testing
