// A study of 40 runs comes out the same however it was carried out.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/study/study_program.h"

namespace migiwa::testing {
namespace {

class StudyOfForty : public StudyProgramTest {
 protected:
  static constexpr int kRuns = 40;

  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "drop.json") << R"({ "format": 1, "particle_spacing": 0.1,
      "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.2, 0.3, 0.2] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0],
                                     "max": [0.3, 0.6, 0.2] } ] } })";
  }

  static Words study(const std::string& out, const Words& more = {}, const char* repeat = "1") {
    Words words{
        "study",     "drop.json",
        "--vary",    "/boundary/handling:/boundary/gamma/method=gamma:auto,gamma:mean,particles,spline,none",
        "--vary",    "/solver/max_iterations=1,2,4,8",
        "--vary",    "/solver/time_step=0.005,0.01",
        "--set",     "/solver/min_iterations=1",
        "--set",     "/solver/tolerance=0",
        "--until",   "0.06",
        "--threads", "1",
        "--quiet",   "--repeat",
        repeat,      "--out",
        out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  void carryOut(const std::string& out) const { expectDone(run(study(out))); }
};

TEST_F(StudyOfForty, StoppedTwiceAndMergedFromFourPartsHasTheSameTable) {
  carryOut("whole");
  const std::string whole = table("whole");
  ASSERT_EQ(std::count(whole.begin(), whole.end(), '\n'), kRuns + 1);

  EXPECT_TRUE(fs::exists(folder_ / "whole" / "over_max_iterations.png"));
  EXPECT_FALSE(fs::exists(folder_ / "whole" / "over_time_step.png")) << "two values show no order";
  EXPECT_NE(readAll(folder_ / "whole" / "summary.md").find("## Orders in max_iterations"), std::string::npos);

  stopWhenThere(study("stopped"), "stopped/runs/7.json", SIGINT);
  const std::string kept = readAll(folder_ / "stopped" / "runs" / "7.json");
  stopWhenThere(study("stopped"), "stopped/runs/23.json", SIGKILL);
  carryOut("stopped");
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

TEST_F(StudyOfForty, TwiceItRanksTheRunsAlikeAndTellsTheSpreadOfTimes) {
  for (const char* out : {"first", "second"}) expectDone(run(study(out, {}, "2")));
  const auto first = columns("first"), second = columns("second");
  const auto ranks = [](const Words& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::stod(values[a]) < std::stod(values[b]);
    });
    return order;
  };
  for (const char* measure : {"density_error_mean", "density_error_max", "gamma_error", "rms_speed"}) {
    ASSERT_EQ(first.at(measure).size(), static_cast<std::size_t>(kRuns)) << measure;
    EXPECT_EQ(ranks(first.at(measure)), ranks(second.at(measure))) << measure;
    EXPECT_NE(first.at(measure).front(), first.at(measure).back()) << measure << " tells nothing apart";
  }
  for (std::size_t k = 0; k < kRuns; ++k) {
    const double least = std::stod(first.at("wall_ms_per_s_min")[k]);
    EXPECT_GT(least, 0);
    EXPECT_GE(std::stod(first.at("wall_ms_per_s_max")[k]), least);
    EXPECT_EQ(first.at("repeats")[k], "2");
  }
}

}  // namespace
}  // namespace migiwa::testing
