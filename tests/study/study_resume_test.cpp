// A study of 40 runs comes out the same however it was carried out, and its runs differ where what is varied
// changes the state, and nowhere else.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/study/study_program.h"

namespace migiwa::testing {
namespace study_resume_test {

class StudyOfForty : public StudyProgramTest {
 protected:
  static constexpr int kRuns = 40;

  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "drop.json") << R"({ "format": 1, "particle_spacing": 0.1,
      "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.3, 0.4, 0.2], "velocity": [2, -4, 0] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0],
                                     "max": [0.4, 0.6, 0.2] } ] } })";
  }

  static Words study(const std::string& out, const Words& more = {}, const char* repeat = "1",
                     const char* threads = "1") {
    Words words{
        "study",     "drop.json",
        "--vary",    "/boundary/handling:/boundary/gamma/method=gamma:auto,gamma:mean,particles,spline,none",
        "--vary",    "/solver/max_iterations=1,2,4,8",
        "--vary",    "/solver/time_step=0.005,0.01",
        "--set",     "/solver/min_iterations=1",
        "--set",     "/solver/tolerance=0",
        "--until",   "0.06",
        "--threads", threads,
        "--quiet",   "--repeat",
        repeat,      "--out",
        out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  static std::set<std::string> distinct(const Words& values) { return {values.begin(), values.end()}; }

  void applyRequest(const std::string& out) const { expectDone(run(study(out))); }
};

TEST_F(StudyOfForty, StoppedTwiceAndMergedFromFourPartsHasTheSameTable) {
  applyRequest("whole");
  const std::string whole = table("whole");
  ASSERT_EQ(std::count(whole.begin(), whole.end(), '\n'), kRuns + 1);
  // No run can take the place of another unnoticed.
  ASSERT_EQ(distinct(columns("whole").at("state_hash")).size(), static_cast<std::size_t>(kRuns));

  EXPECT_TRUE(fs::exists(folder_ / "whole" / "over_max_iterations.png"));
  EXPECT_FALSE(fs::exists(folder_ / "whole" / "over_time_step.png")) << "two values show no order";
  EXPECT_NE(readAll(folder_ / "whole" / "summary.md").find("## Orders in max_iterations"), std::string::npos);

  stopWhenThere(study("stopped"), "stopped/runs/7.json", SIGINT);
  const std::string kept = readAll(folder_ / "stopped" / "runs" / "7.json");
  stopWhenThere(study("stopped"), "stopped/runs/23.json", SIGKILL);
  applyRequest("stopped");
  EXPECT_EQ(table("stopped"), whole);
  EXPECT_EQ(readAll(folder_ / "stopped" / "runs" / "7.json"), kept) << "what was done is not done again";

  Words parts{"--merge"};
  for (int part = 0; part < 4; ++part) {
    const std::string folder = "part" + std::to_string(part);
    for (int k = 1 + part; k <= kRuns; k += 4) expectDone(run(study(folder, {"--run", std::to_string(k)})));
    parts.push_back(folder);
  }
  expectDone(run(study("joined", parts)));
  EXPECT_EQ(table("joined"), whole);
}

TEST_F(StudyOfForty, OnOneThreadAndOnTwoItHasTheSameTableAndTellsTheSpreadOfTimes) {
  expectDone(run(study("first", {}, "2")));
  expectDone(run(study("second", {}, "2", "2")));
  EXPECT_EQ(table("first"), table("second"));
  const auto first = columns("first"), second = columns("second");
  EXPECT_EQ(distinct(first.at("threads")), std::set<std::string>{"1"});
  EXPECT_EQ(distinct(second.at("threads")), std::set<std::string>{"2"});
  for (const char* measure : {"density_error_mean", "density_error_max", "gamma_error", "rms_speed"}) {
    ASSERT_EQ(first.at(measure).size(), static_cast<std::size_t>(kRuns)) << measure;
    // Some settings may come out alike to the last digit that is written; most do not.
    EXPECT_GT(distinct(first.at(measure)).size(), static_cast<std::size_t>(0.8 * kRuns)) << measure;
  }
  for (std::size_t k = 0; k < kRuns; ++k) {
    const double least = std::stod(first.at("wall_ms_per_s_min")[k]);
    EXPECT_GT(least, 0);
    EXPECT_GE(std::stod(first.at("wall_ms_per_s_max")[k]), least);
    EXPECT_EQ(first.at("repeats")[k], "2");
  }
}

TEST_F(StudyOfForty, RunsAreAlikeWhereWhatIsVariedChangesNothing) {
  // The number of directions means something to one of the methods, that of samples to neither, and a colour
  // to no state at all.
  expectDone(run({"study", "drop.json", "--vary", "/boundary/gamma/method=mean,directions", "--vary",
                  "/boundary/gamma/directions=8,16,32,64,128", "--vary", "/boundary/gamma/samples=100,1000",
                  "--vary", "/view/color=density,gamma", "--until", "0.06", "--quiet", "--repeat", "1",
                  "--out", "alike"}));
  const auto found = columns("alike");
  const Words& hashes = found.at("state_hash");
  ASSERT_EQ(hashes.size(), static_cast<std::size_t>(kRuns));
  std::map<std::string, std::set<std::string>> byMethod, byDirections;
  for (std::size_t k = 0; k < hashes.size(); ++k) {
    const std::string& method = found.at("/boundary/gamma/method")[k];
    byMethod[method].insert(hashes[k]);
    if (method == "directions") byDirections[found.at("/boundary/gamma/directions")[k]].insert(hashes[k]);
  }
  EXPECT_EQ(byMethod["mean"].size(), 1U);
  EXPECT_EQ(byMethod["directions"].size(), 5U);
  ASSERT_EQ(byDirections.size(), 5U);
  for (const auto& [directions, states] : byDirections) EXPECT_EQ(states.size(), 1U) << directions;
}

}  // namespace study_resume_test
}  // namespace migiwa::testing
