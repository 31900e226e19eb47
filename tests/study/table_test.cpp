// study.csv of runs made by hand.
#include <gtest/gtest.h>

#include "core/study/study.h"

namespace migiwa {
namespace table_test {

StudyPlan plan() {
  return {"tank.json", {}, {{"/a", {"1", "[2,3]"}}, {"/b", {"x"}}}, 1};
}

FinishedRun finished(std::size_t run, std::vector<RunTiming> timings, double error) {
  RunRecord record;
  record.stateHash = "00ff";
  record.threads = 2;
  record.measures = {{"density_error_mean", error}, {"lost", 0.0}, {"height_error", std::nullopt}};
  record.timings = std::move(timings);
  return {run, plan().values(run), record};
}

TEST(StudyTable, BeginsWithTheColumnsOfTheContract) {
  const std::string csv = studyCsv(plan(), {finished(1, {{8, 2, {}, {}}}, 0.5)});
  EXPECT_TRUE(csv.starts_with(
      "run,/a,/b,wall_ms_per_s,ms_per_step,iterations,gamma_error,density_error_mean,density_error_max,"
      "height_error,edge_crowding,near_wall_spacing_p1,rms_speed,lost,memory_bytes,"))
      << csv;
  EXPECT_NE(csv.find("\n1,1,x,8,2,,,0.5,,,,,,0,,"), std::string::npos) << csv;
}

TEST(StudyTable, ListsAreQuoted) {
  const std::string csv = studyCsv(plan(), {finished(2, {{8, 2, {}, {}}}, 0.5)});
  EXPECT_NE(csv.find("\n2,\"[2,3]\",x,8,"), std::string::npos) << csv;
}

TEST(StudyTable, CostIsTheSumOfTheMediansOfSubsteps) {
  // A simulated second in three substeps; each repetition was disturbed in another one.
  const FinishedRun run = finished(
      1,
      {{1.2, 0.1, {}, {1000, 100, 100}}, {2.2, 0.1, {}, {100, 2000, 100}}, {3.2, 0.1, {}, {100, 100, 3000}}},
      0.5);
  EXPECT_DOUBLE_EQ(runCost(run.record), 0.3);
  // Without substeps the median of the whole.
  EXPECT_DOUBLE_EQ(runCost(finished(1, {{5, 1, {}, {}}, {7, 1, {}, {}}, {90, 1, {}, {}}}, 0).record), 7);
}

TEST(StudyTable, AFailedRunIsOnNoFront) {
  std::vector<FinishedRun> runs{finished(1, {{5, 1, {}, {}}}, 0.1), finished(2, {{9, 1, {}, {}}}, 0.2)};
  EXPECT_EQ(frontOf(runs, accuracyMeasures().front()), (std::vector<std::size_t>{0}));
  runs[0].record.trouble = "lost_particle at step 3";
  EXPECT_EQ(frontOf(runs, accuracyMeasures().front()), (std::vector<std::size_t>{1}));
}

}  // namespace table_test
}  // namespace migiwa
