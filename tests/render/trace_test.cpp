// What is measured along a run and its branches: against the particles themselves and the report's measures,
// and how much of it is kept.
#include <gtest/gtest.h>

#include "app/session/time_line.h"
#include "core/simulation/measures.h"
#include "tests/render/test_scene.h"
#include "tests/render/time_line_runs.h"

namespace migiwa {
namespace trace_test {

class TraceTest : public TimeLineTest {
 protected:
  const TimeLineView::Branch& branch(int number) {
    status_ = simulation_->status();
    for (const TimeLineView::Branch& one : status_.line.branches)
      if (one.number == number) return one;
    throw std::out_of_range("no such branch");
  }
  RunStatus status_;
};

TEST_F(TraceTest, HeightAndFrontAreThoseOfTheParticles) {
  const Scene scene = smallScene();
  Simulation simulation(scene, 1);
  const Meter meter(scene);
  const Bounds bounds = scene.bounds();
  const MeasureSample first = meter.read(simulation);
  EXPECT_TRUE(std::isnan(first[RunMeasure::densityError])) << "there has been no step";
  for (int k = 0; k < 30; ++k) simulation.advanceFrame();
  const MeasureSample sample = meter.read(simulation);
  SettledSampler report;
  report.sample(simulation);
  ASSERT_TRUE(report.result().height);
  EXPECT_NEAR(sample[RunMeasure::height], *report.result().height, 1e-5);
  ASSERT_GT(bounds.size().x(), bounds.size().z());
  float farthest = -1e9F;
  for (const Float4& p : simulation.view().positions) farthest = std::max(farthest, p.x);
  EXPECT_NEAR(sample[RunMeasure::front],
              static_cast<double>(farthest) + 0.5 * scene.particleSpacing - bounds.min.x(), 1e-5);
  EXPECT_GT(sample[RunMeasure::front], first[RunMeasure::front]) << "the column has fallen over";
  EXPECT_EQ(static_cast<int>(sample[RunMeasure::iterations]), simulation.view().info.iterations);
  EXPECT_NEAR(sample[RunMeasure::densityError], 100 * simulation.view().info.errors.back().mean, 1e-4);
}

TEST_F(TraceTest, TheFrontComesFromWhereTheFluidBegan) {
  Scene left = smallScene();
  Scene right =
      parseScene(writeScene(left), "right.json", {{"/fluid/0/min/0", "0.5"}, {"/fluid/0/max/0", "1"}});
  const MeasureSample a = Meter(left).read(Simulation(left, 1)), b = Meter(right).read(Simulation(right, 1));
  EXPECT_NEAR(a[RunMeasure::front], b[RunMeasure::front], 0.51 * left.particleSpacing);
}

TEST_F(TraceTest, ABranchHasItsOwnFromWhereItLeft) {
  const Scene scene = smallScene();
  open(scene);
  stepOn(40);
  const std::vector<MeasureSample> before = *branch(1).trace;
  ASSERT_EQ(before.size(), 41U);
  goTo(1, before[20].time);
  EXPECT_EQ(branch(1).trace->size(), 41U) << "what was measured is not measured again";
  simulation_->apply(without(scene));
  stepOn(15);
  ASSERT_EQ(status_.line.branches.size(), 1U) << "as of before";
  const std::vector<MeasureSample> own = *branch(2).trace;
  ASSERT_EQ(own.size(), 16U);
  EXPECT_EQ(own.front().time, before[20].time);
  EXPECT_EQ(own.front()[RunMeasure::front], before[20][RunMeasure::front]);
  EXPECT_NE(own.back()[RunMeasure::height], before[35][RunMeasure::height])
      << "walls take no part in the density";
  EXPECT_EQ(branch(1).trace->back().time, before.back().time);
}

TEST_F(TraceTest, LongRunsAreThinnedAndKeepBothEnds) {
  Trace trace;
  for (int k = 0; k <= 10003; ++k) {
    MeasureSample sample;
    sample.time = 0.01 * k;
    trace.add(sample);
  }
  const MeasureSamples samples = trace.samples();
  EXPECT_LE(samples->size(), 1025U);
  EXPECT_GE(samples->size(), 512U);
  EXPECT_EQ(samples->front().time, 0);
  EXPECT_EQ(samples->back().time, 0.01 * 10003) << "which is none of every so many";
  EXPECT_EQ(samples, trace.samples()) << "nothing was added";
}

}  // namespace trace_test
}  // namespace migiwa
