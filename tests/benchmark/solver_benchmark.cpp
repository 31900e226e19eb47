// The solver's passes and its whole step at 10k, 100k and 1M particles, against plain scalar code and against
// what the machine can do at most. Before anything is timed, results are checked: fast but different is a
// failure.
//
// usage: migiwa_bench [--csv FILE] [Google Benchmark's options]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include <benchmark/benchmark.h>

#include "core/base/hash.h"
#include "core/solver/effect.h"
#include "core/solver/step.h"
#include "tests/benchmark/machine_peak.h"
#include "tests/support/dense_tank.h"
#include "tests/support/scalar_passes.h"

namespace migiwa::benchmarks {
namespace {

using testing::DenseTank;

/// Floating-point operations a pair, counted in the source.
constexpr double kLambdaFlops = 34, kPositionFlops = 28;

EffectPipeline viscosity() {
  return EffectPipeline({{"viscosity", std::shared_ptr<const Effect>(makeEffect(0))}});
}

std::uint64_t hashAfterSteps(std::size_t n, int threads, int steps) {
  DenseTank tank(n, threads);
  EffectPipeline effects = viscosity();
  for (int k = 0; k < steps; ++k) advanceStep(tank.state(), effects);
  const Particles& particles = tank.state().particles;
  return stateHash(particles.id, particles.position, particles.velocity, tank.state().pool);
}

/// Whether every number of threads gives the same state, and an iteration that of plain scalar code.
bool resultsHold() {
  bool hold = true;
  const std::pair<std::size_t, int> runs[] = {{10000, 20}, {100000, 5}, {1000000, 2}};
  for (const auto& [n, steps] : runs) {
    const std::uint64_t one = hashAfterSteps(n, 1, steps);
    for (const int threads : {2, 3, 8}) {
      if (hashAfterSteps(n, threads, steps) == one) continue;
      std::fprintf(stderr, "%zu particles: %d threads give another state than one\n", n, threads);
      hold = false;
    }
    std::fprintf(stderr, "%zu particles, %d steps: state %016llx\n", n, steps,
                 static_cast<unsigned long long>(one));
  }
  DenseTank tank(10000, 2);
  tank.prepare();
  StepState& state = tank.state();
  const testing::ScalarResult scalar = testing::scalarIteration(state);
  stages::movePositions(state);
  float farthest = 0;
  for (std::size_t i = 0; i < scalar.moved.size(); ++i)
    farthest = std::max(farthest, (state.current[i].xyz() - scalar.moved[i]).norm() / state.supportRadius);
  std::fprintf(stderr, "largest difference to scalar code after an iteration: %.1e support radii\n",
               static_cast<double>(farthest));
  return hold && farthest < 1e-5F;
}

double neighboursPerParticle(const StepState& state, bool filled) {
  double sum = 0;
  for (std::size_t i = 0; i < state.particles.size(); ++i)
    sum += static_cast<double>(filled ? state.neighbours.groups(i).size() : state.neighbours.counts()[i]);
  return sum / static_cast<double>(state.particles.size());
}

struct Work {
  double bytes = 0, flops = 0;  ///< a particle; 0: not counted
};
/// What is timed, made for a tank that is ready for an iteration.
using Pass = std::function<void()>;
using MakePass = std::function<Pass(StepState&)>;

void run(benchmark::State& timing, const MakePass& makePass,
         const std::function<Work(const StepState&)>& work) {
  DenseTank tank(static_cast<std::size_t>(timing.range(0)), static_cast<int>(timing.range(1)));
  tank.prepare();
  StepState& state = tank.state();
  const Pass pass = makePass(state);
  // Into the caches, and pages into memory.
  pass();
  for (auto _ : timing) pass();
  const auto n = static_cast<double>(state.particles.size());
  const auto perSecond = [&](double amount) {
    return benchmark::Counter(amount, benchmark::Counter::kIsIterationInvariantRate);
  };
  timing.counters["particles"] = n;
  timing.counters["threads"] = static_cast<double>(timing.range(1));
  timing.counters["ns_per_particle"] = benchmark::Counter(
      1e-9 * n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  const Work done = work(state);
  timing.counters["bytes_per_particle"] = done.bytes;
  timing.counters["flops_per_particle"] = done.flops;
  timing.counters["GB/s"] = perSecond(1e-9 * n * done.bytes);
  timing.counters["GFLOP/s"] = perSecond(1e-9 * n * done.flops);
}

Work uncounted(const StepState&) {
  return {};
}

/// What an iteration must move from and to memory where nothing stays in the caches: the list, what is read
/// of the particle itself, and what is written.
Work lambdaWork(const StepState& state) {
  return {4 * neighboursPerParticle(state, true) + 16 + 8 + 8 + 16 + 8,
          kLambdaFlops * neighboursPerParticle(state, false)};
}
Work positionWork(const StepState& state) {
  return {4 * neighboursPerParticle(state, true) + 16 + 8 + 4 + 16 + 32,
          kPositionFlops * neighboursPerParticle(state, false)};
}

Pass search(StepState& state) {
  return [&] {
    std::copy(state.particles.position.begin(), state.particles.position.end(), state.current.begin());
    stages::searchNeighbours(state);
  };
}

Pass gamma(StepState& state) {
  return [&] { stages::evaluateGamma(state); };
}

Pass lambda(StepState& state) {
  return [&] { benchmark::DoNotOptimize(stages::computeLambda(state)); };
}

/// Back where they were afterwards, so that every round moves the same particles.
Pass position(StepState& state) {
  return [&] {
    stages::movePositions(state);
    state.current.swap(state.previous);
  };
}

Pass iteration(StepState& state) {
  return [&] {
    benchmark::DoNotOptimize(stages::computeLambda(state));
    stages::movePositions(state);
    stages::projectNearWalls(state);
    stages::refreshGamma(state);
    state.current.swap(state.previous);
  };
}

/// The lambda and the position pass alone.
Pass scalarIteration(StepState& state) {
  return [&state, lists = std::make_shared<testing::IndexLists>(state),
          result = std::make_shared<testing::ScalarResult>()] {
    testing::scalarLambda(state, *lists, *result);
    testing::scalarMove(state, *lists, *result);
  };
}

Pass step(StepState& state) {
  return [&state, effects = viscosity()]() mutable { advanceStep(state, effects); };
}

void registerAll() {
  const auto add = [](const char* name, const MakePass& pass,
                      const std::function<Work(const StepState&)>& work = uncounted) {
    auto* timed = benchmark::RegisterBenchmark(
        name, [pass, work](benchmark::State& timing) { run(timing, pass, work); });
    timed->UseRealTime()->Unit(benchmark::kMillisecond)->ArgNames({"n", "threads"});
    for (const long n : {10000L, 100000L, 1000000L})
      for (const long threads : {1L, 2L}) timed->Args({n, threads});
  };
  add("search", search);
  add("gamma", gamma);
  add("lambda", lambda, lambdaWork);
  add("position", position, positionWork);
  add("iteration", iteration);
  add("scalar_iteration", scalarIteration);
  add("step", step);
  for (const int threads : {1, 2}) {
    const auto pool = std::make_shared<ThreadPool>(threads);
    benchmark::RegisterBenchmark(("peak_bandwidth/threads:" + std::to_string(threads)).c_str(),
                                 [pool](benchmark::State& timing) {
                                   std::size_t bytes = 0;
                                   for (auto _ : timing) bytes += triad(*pool);
                                   timing.counters["GB/s"] = benchmark::Counter(
                                       1e-9 * static_cast<double>(bytes), benchmark::Counter::kIsRate);
                                   timing.counters["threads"] = pool->threads();
                                 })
        ->UseRealTime();
    benchmark::RegisterBenchmark(("peak_arithmetic/threads:" + std::to_string(threads)).c_str(),
                                 [pool](benchmark::State& timing) {
                                   double flops = 0;
                                   for (auto _ : timing) flops += multiplyAdds(*pool);
                                   timing.counters["GFLOP/s"] =
                                       benchmark::Counter(1e-9 * flops, benchmark::Counter::kIsRate);
                                   timing.counters["threads"] = pool->threads();
                                 })
        ->UseRealTime();
  }
}

/// Passes what it sees on to the console and keeps the medians.
class Medians final : public benchmark::ConsoleReporter {
 public:
  struct Row {
    std::string name;
    std::map<std::string, double> values;
  };
  std::vector<Row> rows;

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const bool median = run.run_type == Run::RT_Aggregate && run.aggregate_name == "median";
      if (run.error_occurred || !(median || run.repetitions == 1)) continue;
      Row row{run.run_name.function_name, {}};
      row.values["ms"] = run.GetAdjustedRealTime();
      for (const auto& [name, counter] : run.counters) row.values[name] = counter.value;
      rows.push_back(row);
    }
  }
};

/// One line a benchmark: its medians, and the share of the machine's peaks at the same number of threads.
void writeCsv(const std::string& path, Medians medians) {
  std::sort(medians.rows.begin(), medians.rows.end(), [](const Medians::Row& a, const Medians::Row& b) {
    const auto place = [](const Medians::Row& row) {
      const auto particles = row.values.find("particles");
      return std::tuple(row.name, row.values.at("threads"),
                        particles == row.values.end() ? 0.0 : particles->second);
    };
    return place(a) < place(b);
  });
  std::map<int, double> bandwidth, arithmetic;
  for (const Medians::Row& row : medians.rows) {
    if (row.name.starts_with("peak_bandwidth"))
      bandwidth[static_cast<int>(row.values.at("threads"))] = row.values.at("GB/s");
    if (row.name.starts_with("peak_arithmetic"))
      arithmetic[static_cast<int>(row.values.at("threads"))] = row.values.at("GFLOP/s");
  }
  std::ofstream out(path);
  out << "benchmark,particles,threads,ms,ns_per_particle,bytes_per_particle,flops_per_particle,"
         "share_of_bandwidth,share_of_arithmetic\n";
  for (const Medians::Row& row : medians.rows) {
    if (row.name.starts_with("peak")) continue;
    const auto& values = row.values;
    const int threads = static_cast<int>(values.at("threads"));
    const auto share = [&](const char* counter, const std::map<int, double>& peak) {
      return peak.contains(threads) ? values.at(counter) / peak.at(threads) : 0.0;
    };
    out << row.name << ',' << values.at("particles") << ',' << threads << ',' << values.at("ms") << ','
        << values.at("ns_per_particle") << ',' << values.at("bytes_per_particle") << ','
        << values.at("flops_per_particle") << ',' << share("GB/s", bandwidth) << ','
        << share("GFLOP/s", arithmetic) << '\n';
  }
}

}  // namespace
}  // namespace migiwa::benchmarks

int main(int argc, char** argv) {
  std::string csv;
  if (argc > 2 && std::string(argv[1]) == "--csv") {
    csv = argv[2];
    argv[2] = argv[0];
    argc -= 2, argv += 2;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  if (!migiwa::benchmarks::resultsHold()) return 1;
  migiwa::benchmarks::registerAll();
  migiwa::benchmarks::Medians medians;
  benchmark::RunSpecifiedBenchmarks(&medians);
  if (!csv.empty()) migiwa::benchmarks::writeCsv(csv, medians);
  return 0;
}
