// Reports out and in again, and what they say of a run.
#include "core/io/report.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/simulation/measures.h"

namespace migiwa {
namespace report_test {

class ReportFile : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("migiwa_report_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
             ".json");
  }
  void TearDown() override { std::filesystem::remove(file_); }

  Report throughFile(const std::string& text) const {
    writeTextFile(file_, text);
    return readReport(file_);
  }
  std::string faultsOf(const std::string& text) const {
    try {
      throughFile(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path file_;
};

Report filledReport() {
  Report report;
  report.scene = "scenes/a \"b\".json";
  report.overrides = {"/solver/cfl=0", "/name=x"};
  report.steps = 800;
  report.simulatedSeconds = 4;
  report.wallSeconds = 3.125;
  report.threads = 2;
  report.particles = 9216;
  report.stateHash = "00ff00ff00ff00ff";
  report.handling = "gamma";
  report.gammaMethod = "product";
  report.gammaReason = "because";
  report.stepMedian = 3.5;
  report.stages = {{"neighbours", 0.0005}, {"lambda", 0.001}};
  report.nanosecondsPerParticleIteration = 41;
  report.iterationsMean = 3.5;
  report.iterationsMax = 20;
  report.pressureIterationsMean = 4.5;
  report.densityErrorMean = 0.0078125;
  report.densityErrorMax = 0.125;
  report.lostParticles = 0;
  report.startedParticles = 9000;
  report.emittedParticles = 516;
  report.leftParticles = 100;
  report.leftVolume = 0.0125;
  report.drainedParticles = 200;
  report.drainedVolume = 0.025;
  report.drains = {{200, 0.025, {0.5, 1}, {0.0125, 0.025}}};
  report.gauges = {{"left", "height", "m", {0, 0.5, 1}, {0.25, 0.5, 0.75}},
                   {"floor", "pressure", "Pa", {0.5, 1}, {100, 200}}};
  report.trouble = {{"not_converged", 12, 3, "error 0.04"}};
  report.settled.height = 0.75;
  report.settled.edgeCrowding = 1.0625;
  return report;
}

TEST_F(ReportFile, ComesBackTheSame) {
  const std::string text = reportText(filledReport());
  const Report again = throughFile(text);
  EXPECT_EQ(reportText(again), text);
  EXPECT_EQ(again.scene, "scenes/a \"b\".json");
  EXPECT_EQ(again.overrides.size(), 2U);
  EXPECT_EQ(again.particles, 9216);
  EXPECT_EQ(again.settled.height, 0.75);
  EXPECT_FALSE(again.settled.expectedHeight.has_value());
  ASSERT_EQ(again.stages.size(), 2U);
  EXPECT_DOUBLE_EQ(again.stages[1].seconds, 0.001);
  ASSERT_EQ(again.trouble.size(), 1U);
  EXPECT_EQ(again.trouble[0].step, 12);
  ASSERT_EQ(again.gauges.size(), 2U);
  EXPECT_EQ(again.gauges[1].name + again.gauges[1].kind + again.gauges[1].unit, "floorpressurePa");
  EXPECT_EQ(again.gauges[0].times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(again.gauges[0].values, (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_EQ(gaugesCsv(again), "time (s),left (m),floor (Pa)\n0,0.25,\n0.5,0.5,100\n1,0.75,200\n");
  ASSERT_EQ(again.drains.size(), 1U);
  EXPECT_EQ(again.drains[0].times, (std::vector<double>{0.5, 1}));
  EXPECT_EQ(again.drains[0].volumes, (std::vector<double>{0.0125, 0.025}));
}

TEST_F(ReportFile, HasTheKeysThatPeopleScriptAgainst) {
  const std::string text = reportText(filledReport());
  for (const char* key : {"scene",
                          "steps",
                          "simulated_s",
                          "wall_s",
                          "threads",
                          "particles",
                          "state_hash",
                          "step_ms",
                          "median",
                          "p95",
                          "stages_ms",
                          "neighbours",
                          "ns_per_particle_iteration",
                          "iterations",
                          "mean",
                          "max",
                          "density_error",
                          "lost_particles",
                          "nonfinite_particles",
                          "totals",
                          "started",
                          "emitted",
                          "left",
                          "volume",
                          "drained",
                          "drains",
                          "times",
                          "volumes",
                          "max_penetration",
                          "max_speed",
                          "peak_memory_bytes",
                          "energy",
                          "start",
                          "kinetic",
                          "potential",
                          "work",
                          "walls",
                          "emitters",
                          "outflow",
                          "effects",
                          "dissipated",
                          "largest_gain",
                          "stored_at_start",
                          "trouble",
                          "kind",
                          "step",
                          "detail",
                          "settled",
                          "height",
                          "expected_height",
                          "near_wall_spacing_p1",
                          "bulk_spacing_p1",
                          "edge_crowding",
                          "rms_speed"})
    EXPECT_NE(text.find("\"" + std::string(key) + "\":"), std::string::npos) << key;
}

TEST_F(ReportFile, WhatIsNotFiniteIsNull) {
  Report report = filledReport();
  report.maxSpeed = INFINITY;
  report.maxPenetration = NAN;
  report.settled.height = -INFINITY;
  const std::string text = reportText(report);
  EXPECT_NE(text.find("\"max_speed\": null"), std::string::npos) << text;
  EXPECT_NE(text.find("\"max_penetration\": null"), std::string::npos) << text;
  EXPECT_NE(text.find("\"height\": null"), std::string::npos) << text;
}

TEST_F(ReportFile, MissingKeysAreNull) {
  const Report report = throughFile(R"({"steps": 3, "particles": 5})");
  EXPECT_EQ(report.steps, 3);
  EXPECT_FALSE(report.stepMedian.has_value());
  EXPECT_TRUE(report.trouble.empty());
}

TEST_F(ReportFile, FaultsComeAllAtOnce) {
  const std::string place = file_.string() + ":";
  EXPECT_EQ(
      faultsOf(R"({"steps": "3", "particles": 5, "stages_ms": {"lambda": []}, "trouble": [{"kind": 1}]})"),
      place + "/steps: expected a number or null, found \"3\"\n" + place +
          "/stages_ms/lambda: expected a number or null, found an empty array\n" + place +
          "/trouble/0: expected an object with kind, step, count and detail, found an object");
  EXPECT_EQ(faultsOf("[]").find(place + "/: expected a report"), 0U);
  EXPECT_EQ(faultsOf("{\"steps\": }").find(place + "1:11: expected a value"), 0U)
      << faultsOf("{\"steps\": }");
}

TEST_F(ReportFile, SaysWhatARunDid) {
  const std::vector<Override> overrides{{"/duration", "0.05"}};
  const Scene scene = readScene(MIGIWA_SOURCE_DIR "/scenes/corner_drop.json", overrides);
  Simulation simulation(scene, 2);
  const SettledMeasures settled = runUntil(simulation, 0.05);
  const RunStatistics& run = simulation.statistics();
  const Report report = makeReport(simulation, settled, overrides);

  EXPECT_EQ(report.scene, scene.file.string());
  EXPECT_EQ(report.overrides, std::vector<std::string>{"/duration=0.05"});
  EXPECT_EQ(report.threads, 2);
  EXPECT_EQ(report.particles, static_cast<double>(simulation.view().positions.size()));
  EXPECT_EQ(report.steps, static_cast<double>(run.steps));
  EXPECT_NEAR(*report.simulatedSeconds, 0.05, 1e-9);
  EXPECT_EQ(report.stateHash.size(), 16U);
  EXPECT_EQ(report.stateHash.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(report.handling, "gamma");
  EXPECT_FALSE(report.gammaMethod.empty());
  EXPECT_GT(*report.stepMedian, 0);
  EXPECT_GE(*report.stepP95, *report.stepMedian);
  EXPECT_GT(*report.peakMemoryBytes, 1e6);
  EXPECT_GE(*report.iterationsMean, scene.solver.minIterations);
  EXPECT_LE(*report.iterationsMax, scene.solver.maxIterations);

  // The stages are parts of the step, so they sum up to no more than the run took.
  double stages = 0;
  for (const StageTime& stage : report.stages) stages += stage.seconds;
  EXPECT_GT(stages, 0);
  EXPECT_LE(stages * *report.steps, *report.wallSeconds * 1.001);

  const double iterating = run.stages.seconds("lambda") + run.stages.seconds("position") +
                           run.stages.seconds("projection") + run.stages.seconds("gamma_refresh");
  EXPECT_NEAR(*report.nanosecondsPerParticleIteration * 1e-9 * *report.particles * run.iterationSum,
              iterating, 1e-9 * iterating);
}

TEST_F(ReportFile, NoStepsAndNoParticlesAreNoDivisionsByZero) {
  Simulation simulation(parseScene(R"({"format": 1})", "empty.json"), 1);
  const Report report = makeReport(simulation, {}, {});
  EXPECT_EQ(report.steps, 0);
  EXPECT_EQ(report.particles, 0);
  EXPECT_FALSE(report.stepMedian.has_value());
  EXPECT_FALSE(report.nanosecondsPerParticleIteration.has_value());
  EXPECT_EQ(reportText(report).find("nan"), std::string::npos);
}

}  // namespace report_test
}  // namespace migiwa
