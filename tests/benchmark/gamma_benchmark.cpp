// What one evaluation of gamma costs near a wall, for every method and kind of wall, in batches as the solver
// makes them. One thread. Read "per_gamma".
#include <algorithm>
#include <random>
#include <string>

#include <benchmark/benchmark.h>

#include "core/gamma/gamma_method.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace {

constexpr float kSupport = 0.1F;
constexpr std::size_t kBatch = 64, kPoints = 1024;

/// Walls, and where they are looked at: points in the fluid within the support radius of a wall.
struct Place {
  std::string name;
  Boundary boundary;
  std::vector<Float4> points;
};

Place place(std::string name, std::vector<std::shared_ptr<const Surface>> surfaces, const Vec3f& low,
            const Vec3f& high) {
  Place made{std::move(name), Boundary(std::move(surfaces)), {}};
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  while (made.points.size() < kPoints) {
    const Vec3f p = low + Vec3f(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    const float d = made.boundary.distance(p);
    if (d > 0 && d < kSupport) made.points.emplace_back(p);
  }
  return made;
}

std::vector<Place> places() {
  const auto tank = std::make_shared<Box>(Vec3d::Zero(), Vec3d(3.2, 2, 1.6), Box::Fluid::inside);
  std::vector<Place> all;
  all.push_back(place("tank_plane", {tank}, {1, 0, 0.5F}, {2, 0.1F, 1}));
  all.push_back(place("tank_edge", {tank}, {1, 0, 0}, {2, 0.1F, 0.1F}));
  all.push_back(place("tank_corner", {tank}, {0, 0, 0}, {0.1F, 0.1F, 0.1F}));
  all.push_back(place("wedge_60",
                      {std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()),
                       std::make_shared<Plane>(Vec3d::Zero(), Vec3d(0.8660254, -0.5, 0))},
                      {0, 0, 0}, {0.1F, 0.1F, 0.1F}));
  all.push_back(place("sphere_4h", {std::make_shared<Sphere>(Vec3d::Zero(), 0.4, Sphere::Fluid::inside)},
                      {-0.4F, -0.4F, -0.4F}, {0.4F, 0.4F, 0.4F}));
  all.push_back(
      place("bowl",
            {std::make_shared<Polynomial>(Vec3d::Zero(), Vec3d::UnitZ(), Vec3d::UnitX(), 0.4,
                                          std::vector<Polynomial::Term>{{2, 0, 2.5}, {0, 2, 1.25}})},
            {-0.15F, -0.15F, 0}, {0.15F, 0.15F, 0.2F}));
  return all;
}

/// What a grid has to cover.
Bounds regionOf(const Place& place) {
  Bounds region;
  for (const Float4& p : place.points) region.include(p.xyz().cast<double>());
  return region;
}

void run(benchmark::State& state, const Place& place, const GammaMethod& method) {
  std::vector<GammaSample> samples(kBatch);
  std::size_t at = 0;
  for (auto _ : state) {
    method.evaluate(std::span(place.points).subspan(at, kBatch), samples);
    benchmark::DoNotOptimize(samples.data());
    benchmark::ClobberMemory();
    at = (at + kBatch) % kPoints;
  }
  state.counters["per_gamma"] = benchmark::Counter(static_cast<double>(state.iterations()) * kBatch,
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  const std::vector<Place> all = places();
  std::vector<PickedGamma> kept;
  const auto names = gammaMethodNames();
  for (const Place& at : all) {
    for (std::size_t index = 0; index < names.size(); ++index) {
      for (const int directions : {256, 1024}) {
        const bool byDirections = names[index] == "directions";
        if (directions != 256 && !byDirections) continue;
        kept.push_back(makeGammaMethod(static_cast<int>(index), {at.boundary, KernelType::poly6, kSupport,
                                                                 directions, 10000, regionOf(at)}));
        std::string name = at.name + "/" + std::string(names[index]);
        if (byDirections) name += "_" + std::to_string(directions);
        benchmark::RegisterBenchmark(name.c_str(), [&at, method = kept.back().method.get()](
                                                       benchmark::State& state) { run(state, at, *method); });
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace migiwa

int main(int count, char** arguments) {
  return migiwa::main(count, arguments);
}
