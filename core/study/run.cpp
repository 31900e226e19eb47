#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/io/report.h"
#include "core/simulation/measures.h"
#include "core/study/series.h"
#include "core/study/study.h"

namespace migiwa {

namespace {

Measure relative(const Measure& value, const Measure& expected) {
  return value && expected && *expected > 0 ? Measure(*value / *expected - 1) : std::nullopt;
}

RunTiming timingOf(const Report& report, const RunStatistics& statistics) {
  const double simulated = report.simulatedSeconds.value_or(0);
  RunTiming timing{simulated > 0 ? 1e3 * *report.wallSeconds / simulated : 0,
                   report.stepMedian.value_or(0),
                   report.stages,
                   {}};
  for (const float seconds : statistics.stepSeconds)
    timing.stepMicroseconds.push_back(static_cast<int>(std::lround(1e6F * seconds)));
  return timing;
}

std::string troubleOf(const Report& report) {
  std::string text;
  for (const Trouble& trouble : report.trouble)
    text += (text.empty() ? "" : "; ") + trouble.kind + " at step " + std::to_string(trouble.step) + ": " +
            trouble.detail;
  return text;
}

/// Reads the scene and makes all that is made once, as if for the first time, in `seconds`.
std::unique_ptr<Simulation> prepared(const StudyPlan& plan, std::size_t run, int threads, double& seconds) {
  const CacheBypass anew;
  StageTimes once;
  std::unique_ptr<Simulation> simulation;
  once.time("precomputation", [&] {
    simulation = std::make_unique<Simulation>(readScene(plan.scene, plan.overrides(run)), threads);
  });
  seconds = once.seconds("precomputation");
  return simulation;
}

/// Mean distance (m) of fitted walls from their shapes, the largest of all walls; null where none is fitted.
Measure wallError(const Scene& scene) {
  Measure largest;
  for (const auto& surface : scene.surfaces)
    if (const Measure error = surface->fitError()) largest = std::max(largest.value_or(0), *error);
  return largest;
}

/// Of the gauges: the wave that the first one shows, and the mean of each over the last tenth of the run.
void measureGauges(const Report& report, RunRecord& record) {
  WaveMeasures wave;
  for (const GaugeReport& gauge : report.gauges) {
    const Series series{gauge.times, gauge.values};
    if (&gauge == &report.gauges.front()) wave = waveMeasures(series);
    const double end = report.simulatedSeconds.value_or(0);
    record.measures.emplace_back("gauge_" + gauge.name, meanBetween(series, 0.9 * end, end));
  }
  record.measures.emplace_back("wave_kept", wave.kept);
  record.measures.emplace_back("wave_period", wave.period);
}

}  // namespace

RunRecord firstRepetition(const StudyPlan& plan, std::size_t run, int threads,
                          const std::function<void(const Simulation&)>& eachFrame) {
  double preparation = 0;
  const std::unique_ptr<Simulation> made = prepared(plan, run, threads, preparation);
  RunRecord record;
  record.fingerprint = runFingerprint(made->scene(), plan.until);
  // Fits and grids that are made anew take memory for a while that a start with kept ones does not.
  resetPeakMemory();
  Simulation& simulation = *made;
  ReferenceSampler reference(threads);
  PressureProfile pressure;
  const long last = simulation.frameAt(plan.until), firstSettled = 9 * last / 10;
  // Of the run alone: judging a state takes memory of its own.
  double memory = peakMemory();
  const SettledMeasures settled = runUntil(simulation, plan.until, [&] {
    eachFrame(simulation);
    const long frame = simulation.frame();
    if (frame == firstSettled) simulation.watchPressure(true);
    if (frame > firstSettled) pressure.sample(simulation);
    if (simulation.stopped() || kJudgedStates * frame / last == kJudgedStates * (frame - 1) / last)
      return true;
    memory = std::max(memory, peakMemory());
    reference.sample(simulation);
    resetPeakMemory();
    return true;
  });
  const Report report = makeReport(simulation, settled, plan.overrides(run));
  const RunStatistics& statistics = simulation.statistics();
  const ReferenceErrors errors = reference.result();

  record.overrides = report.overrides;
  record.stateHash = report.stateHash;
  record.gammaMethod = report.gammaMethod;
  record.threads = simulation.threads();
  if (statistics.failed()) record.trouble = troubleOf(report);
  record.measures = {{"iterations", report.iterationsMean},
                     {"gamma_error", errors.gammaMean},
                     {"density_error_mean", errors.densityMean},
                     {"density_error_max", errors.densityMax},
                     {"height_error", relative(settled.height, settled.expectedHeight)},
                     {"edge_crowding", settled.edgeCrowding},
                     {"near_wall_spacing_p1", settled.nearWallSpacingP1},
                     {"rms_speed", settled.rmsSpeed},
                     {"lost", report.lostParticles},
                     {"memory_bytes", memory},
                     {"gamma_error_max", errors.gammaMax},
                     {"solver_density_error_mean", report.densityErrorMean},
                     {"bulk_spacing_p1", settled.bulkSpacingP1},
                     {"particles", report.particles},
                     {"steps", report.steps},
                     {"nonfinite", report.nonfiniteParticles},
                     {"gamma_gradient_error", errors.gradientMean},
                     {"pressure_error", pressure.error()},
                     {"energy_gained", report.energyGain},
                     {"energy_stored", report.energyStored},
                     {"wall_error", wallError(simulation.scene())},
                     {"precomputation_ms", 1e3 * preparation}};
  measureGauges(report, record);
  record.pressure = pressure.layers();
  record.energy = statistics.energy.history;
  record.timings.push_back(timingOf(report, statistics));
  return record;
}

void repeatRun(const StudyPlan& plan, std::size_t run, int threads,
               const std::function<void(const Simulation&)>& eachFrame, RunRecord& record) {
  const std::vector<Override> overrides = plan.overrides(run);
  const Scene scene = readScene(plan.scene, overrides);
  if (runFingerprint(scene, plan.until) != record.fingerprint)
    throw InputError(plan.scene.string(), "expected the scene and the files of run " + std::to_string(run) +
                                              " as they were when it began, found them changed; take "
                                              "another --out");
  Simulation simulation(scene, threads);
  const SettledMeasures settled = runUntil(simulation, plan.until, [&] {
    eachFrame(simulation);
    return true;
  });
  const Report report = makeReport(simulation, settled, overrides);
  if (report.stateHash != record.stateHash)
    throw InputError("--out", "run " + std::to_string(run) + " was recorded with state " + record.stateHash +
                                  " and now ends in " + report.stateHash +
                                  ": recorded by another build of the program; take another --out");
  record.timings.push_back(timingOf(report, simulation.statistics()));
}

WhatIf::WhatIf(const Scene& scene, int threads) : copy_(scene, threads) {}

WhatIfAnswer WhatIf::ask(const StateImage& state, const Settings& settings, int frames,
                         const std::function<void(const Simulation&)>& eachFrame) {
  state.restore(copy_);
  copy_.apply(settings);
  WhatIfAnswer answer;
  answer.time = copy_.time();
  const RunStatistics& statistics = copy_.statistics();
  const long stepsBefore = statistics.steps;
  const double iterationsBefore = statistics.iterationSum;
  std::size_t counted = statistics.stepSeconds.size();
  for (int frame = 0; frame < frames && !copy_.stopped(); ++frame) {
    copy_.advanceFrame();
    if (frame == 0) counted = statistics.stepSeconds.size();
    if (eachFrame) eachFrame(copy_);
  }

  std::vector<float> seconds(statistics.stepSeconds.begin() + static_cast<std::ptrdiff_t>(counted),
                             statistics.stepSeconds.end());
  if (!seconds.empty()) {
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    answer.stepSeconds = static_cast<double>(*middle);
  }
  if (const long steps = statistics.steps - stepsBefore; steps > 0)
    answer.iterations = (statistics.iterationSum - iterationsBefore) / static_cast<double>(steps);
  const FrameInfo& info = copy_.view().info;
  answer.handling = info.handling;
  if (!info.errors.empty()) answer.solverError = info.errors.back().mean;
  if (statistics.failed() && !statistics.trouble.empty())
    answer.trouble = statistics.trouble.back().kind + ": " + statistics.trouble.back().detail;
  ReferenceSampler sampler(copy_.threads());
  sampler.sample(copy_);
  answer.errors = sampler.result();
  return answer;
}

}  // namespace migiwa
