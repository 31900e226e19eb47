// What the surface of 100,000 particles costs: a dam break at rest and one that has begun to run, medians of
// the stages; then the same from a file of particles to a file of the mesh.
//
// usage: surface_benchmark [threads] [repetitions]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/io/particle_export.h"
#include "core/io/surface_files.h"
#include "core/scene/scene_file.h"
#include "core/simulation/scene_surface.h"
#include "core/simulation/simulation.h"

namespace migiwa::benchmarks {
namespace {

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

template <class Body>
double secondsOf(const Body& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void timeFrame(const Simulation& simulation, SceneSurface& surface, int repetitions) {
  const FrameView view = simulation.view();
  std::vector<double> totals;
  std::vector<StageTimes> stages(static_cast<std::size_t>(repetitions));
  SurfaceMesh mesh;
  for (StageTimes& times : stages)
    totals.push_back(
        secondsOf([&] { mesh = surface.mesh(view.positions, view.velocities, simulation.time(), &times); }));
  std::printf("%.2f s: %zu particles, %zu vertices, %zu triangles\n", simulation.time(),
              view.positions.size(), mesh.positions.size(), mesh.triangles.size());
  for (const StageTime& stage : stages.front().stages()) {
    std::vector<double> values;
    for (const StageTimes& times : stages) values.push_back(1e3 * times.seconds(stage.name));
    std::printf("  %-12s %8.1f ms\n", stage.name.c_str(), medianOf(values));
  }
  std::printf("  %-12s %8.1f ms\n", "all", 1e3 * medianOf(totals));

  const std::filesystem::path file = std::filesystem::temp_directory_path() / "surface_benchmark.ply";
  const std::vector<std::string> fields{"velocity"};
  ParticleFrame frame = copyParticles(view, simulation.frame(), fields, simulation.scene().origin);
  frame.sortById();
  writeTextFile(file, plyFormat().text(frame));
  std::vector<double> files;
  for (int k = 0; k < repetitions; ++k) {
    files.push_back(secondsOf([&] {
      const ImportedParticles particles = readParticles(file);
      const SurfaceMesh made = surface.mesh(particles.positions, particles.velocities, simulation.time());
      writeTextFile(file.string() + ".mesh", surfaceFormats().front().text({made, simulation.time()}));
    }));
  }
  std::filesystem::remove(file.string() + ".mesh");
  std::filesystem::remove(file);
  std::printf("  %-12s %8.1f ms\n", "file to file", 1e3 * medianOf(files));
}

void measure(int threads, int repetitions) {
  Simulation simulation(readScene(MIGIWA_SOURCE_DIR "/scenes/large/dam_break_100k.json"), threads);
  ThreadPool pool(threads);
  SceneSurface surface(simulation.scene(), {}, pool);
  timeFrame(simulation, surface, repetitions);
  while (simulation.time() < 0.3) simulation.advanceFrame();
  timeFrame(simulation, surface, repetitions);
}

}  // namespace
}  // namespace migiwa::benchmarks

int main(int argc, char** argv) {
  migiwa::benchmarks::measure(argc > 1 ? std::atoi(argv[1]) : 0,
                              argc > 2 ? std::max(1, std::atoi(argv[2])) : 9);
  return 0;
}
