// Who is told of what takes long, and of what part.
#include "core/base/progress.h"

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/parallel.h"

namespace migiwa {
namespace progress_test {

class Listener final : public ProgressObserver {
 public:
  void reached(std::string_view what, double part) override { told.push_back({std::string(what), part}); }
  void ended() override { ++ends; }

  struct Told {
    std::string what;
    double part;
  };
  std::vector<Told> told;
  int ends = 0;
};

TEST(Progress, AnActivitySaysHowFarItIs) {
  Listener listener;
  const ProgressScope scope(listener);
  {
    Activity activity("fitting");
    activity.reach(0.25);
    activity.reach(1);
  }
  ASSERT_EQ(listener.told.size(), 3U);
  EXPECT_EQ(listener.told[1].what, "fitting");
  EXPECT_EQ(listener.told[0].part, 0);
  EXPECT_EQ(listener.told[1].part, 0.25);
  EXPECT_EQ(listener.told[2].part, 1);
  EXPECT_EQ(listener.ends, 1);
}

TEST(Progress, AParallelLoopTellsItsChunksForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    Listener listener;
    const ProgressScope scope(listener);
    const Activity activity("measuring");
    std::size_t before = 0;
    // A thread that others leave no chunk tells nothing: it may take several loops.
    for (int loop = 0; loop < 1000 && listener.told.size() < 100; ++loop) {
      before = listener.told.size();
      pool.run(64, [](std::size_t) {});
      for (std::size_t k = before + 1; k < listener.told.size(); ++k)
        ASSERT_GT(listener.told[k].part, listener.told[k - 1].part);
    }
    EXPECT_GE(listener.told.size(), 100U) << threads;
    EXPECT_EQ(listener.told.back().what, "measuring");
    EXPECT_LE(listener.told.back().part, 1);
  }
}

TEST(Progress, WhatSaysItselfHowFarItIsIsNotOverruledByItsLoops) {
  ThreadPool pool(1);
  Listener listener;
  const ProgressScope scope(listener);
  Activity activity("fitting");
  activity.reach(0.5);
  pool.run(4, [](std::size_t) {});
  for (std::size_t k = 1; k < listener.told.size(); ++k) EXPECT_EQ(listener.told[k].part, 0.5);
  EXPECT_EQ(listener.told.size(), 6U);
}

TEST(Progress, OneWithinAnotherIsShownInsteadOfIt) {
  Listener listener;
  const ProgressScope scope(listener);
  {
    const Activity outer("outer");
    { const Activity inner("inner"); }
    Activity::pulse(0.5);
    EXPECT_EQ(listener.ends, 0);
  }
  ASSERT_EQ(listener.told.size(), 3U);
  EXPECT_EQ(listener.told[1].what, "inner");
  EXPECT_EQ(listener.told[2].what, "outer");
  EXPECT_EQ(listener.ends, 1);
}

TEST(Progress, NobodyElseIsTold) {
  Listener listener;
  std::optional<ProgressScope> scope(std::in_place, listener);
  std::thread([] { const Activity elsewhere("on another thread"); }).join();
  EXPECT_TRUE(listener.told.empty());
  Activity::pulse(0.5);
  EXPECT_TRUE(listener.told.empty()) << "a loop that belongs to no activity, such as one of a step";
  scope.reset();
  const Activity unwatched("after the scope");
  EXPECT_FALSE(Activity::watched());
  EXPECT_TRUE(listener.told.empty());
}

}  // namespace progress_test
}  // namespace migiwa
