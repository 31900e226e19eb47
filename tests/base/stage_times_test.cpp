#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "core/base/parallel.h"

namespace migiwa {
namespace stage_times_test {

std::vector<std::string> names(const StageTimes& times) {
  std::vector<std::string> result;
  for (const StageTime& stage : times.stages()) result.push_back(stage.name);
  return result;
}

TEST(StageTimes, KeepsTheOrderOfFirstUseAndAddsUp) {
  StageTimes times;
  times.add("neighbours", 0.5);
  times.add("gamma", 0.25);
  times.add("neighbours", 0.125);
  EXPECT_EQ(names(times), (std::vector<std::string>{"neighbours", "gamma"}));
  EXPECT_EQ(times.seconds("neighbours"), 0.625);
  EXPECT_EQ(times.seconds("gamma"), 0.25);
}

TEST(StageTimes, AStageThatNeverRanHasNoEntry) {
  StageTimes times;
  times.add("lambda", 1);
  EXPECT_EQ(times.seconds("position"), 0);
  EXPECT_EQ(times.stages().size(), 1u);
}

TEST(StageTimes, MergesAnotherRun) {
  StageTimes run, step;
  run.add("lambda", 1);
  step.add("position", 2);
  step.add("lambda", 4);
  run.add(step);
  EXPECT_EQ(names(run), (std::vector<std::string>{"lambda", "position"}));
  EXPECT_EQ(run.seconds("lambda"), 5);
  EXPECT_EQ(run.seconds("position"), 2);
}

TEST(StageTimes, ClearForgetsEverything) {
  StageTimes times;
  times.add("lambda", 1);
  times.clear();
  EXPECT_TRUE(times.stages().empty());
}

TEST(StageTimes, TimeBooksAtLeastAsLongAsTheBodyTook) {
  StageTimes times;
  bool ran = false;
  times.time("sleep", [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ran = true;
  });
  EXPECT_TRUE(ran);
  EXPECT_GE(times.seconds("sleep"), 0.02);
  EXPECT_LT(times.seconds("sleep"), 10);
}

}  // namespace stage_times_test
}  // namespace migiwa
