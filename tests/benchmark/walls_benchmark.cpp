// What a step costs among many boxes, over what it costs in the tank without them: processor time a particle
// and step over the first 0.6 s, in which 28,560 particles fall onto the boxes. The runs take turns frame by
// frame, so that what else the machine does falls on all. One thread.
//
// usage: walls_benchmark [NAME]...   all layouts, or those named
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa::benchmarks {
namespace {

/// Writes walls of a scene.
class Boxes {
 public:
  void add(const Vec3d& low, const Vec3d& size) {
    const Vec3d high = low + size;
    text_ << R"(, {"shape": "box", "fluid": "outside", "min": [)" << low.x() << ", " << low.y() << ", "
          << low.z() << R"(], "max": [)" << high.x() << ", " << high.y() << ", " << high.z() << "]}";
  }
  /// An edge from `least` to `most` (m).
  double edge(double least, double most) { return std::uniform_real_distribution(least, most)(random_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::mt19937 random_{2};
};

/// Calls visit(x, z) on a grid of places `pitch` (m) apart on the tank's floor, `columns` by `rows`.
template <class Visit>
void onFloor(int columns, int rows, double first, double pitch, const Visit& visit) {
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) visit(first + pitch * i, first + pitch * j);
}

/// 500 on the floor, up to the water's lower side; thin ones hide what is behind them.
std::string posts() {
  Boxes boxes;
  onFloor(25, 20, 0.2, 0.16, [&](double x, double z) {
    const double edge = boxes.edge(0.02, 0.05);
    boxes.add({x, 0, z}, {edge, 0.4, edge});
  });
  return boxes.text();
}

std::string plates() {
  Boxes boxes;
  onFloor(25, 20, 0.2, 0.16, [&](double x, double z) { boxes.add({x, 0, z}, {0.01, 0.3, 0.1}); });
  return boxes.text();
}

std::string thickBlocks() {
  Boxes boxes;
  onFloor(13, 10, 0.2, 0.32, [&](double x, double z) {
    const double edge = boxes.edge(0.11, 0.15);
    boxes.add({x, 0, z}, {edge, 0.4, edge});
  });
  return boxes.text();
}

/// 5,000 everywhere in the tank.
std::string cubes() {
  Boxes boxes;
  for (int layer = 0; layer < 10; ++layer)
    onFloor(25, 20, 0.2, 0.16, [&](double x, double z) {
      const double edge = boxes.edge(0.02, 0.05);
      boxes.add({x, 0.05 + 0.16 * layer, z}, {edge, edge, edge});
    });
  return boxes.text();
}

/// 5,040 side by side on the floor.
std::string bed() {
  Boxes boxes;
  onFloor(80, 63, 0.03, 0.052, [&](double x, double z) {
    const double edge = boxes.edge(0.01, 0.03);
    boxes.add({x, 0, z}, {edge, edge, edge});
  });
  return boxes.text();
}

/// 500 a layer above the water; one in fifty stands in it.
std::string scenery(int layers) {
  Boxes boxes;
  int placed = 0;
  for (int layer = 0; layer < layers; ++layer)
    onFloor(25, 20, 0.2, 0.16, [&](double x, double z) {
      const double edge = boxes.edge(0.02, 0.05), low = 1 + 0.09 * layer;
      const double foot = placed++ % 50 == layer ? 0 : low;
      boxes.add({x, foot, z}, {edge, low + edge - foot, edge});
    });
  return boxes.text();
}

struct Run {
  std::string label;
  std::unique_ptr<Simulation> simulation;
  std::clock_t time = 0;  ///< of the processor, in steps
  double particleSteps = 0;

  double nanoseconds() const { return 1e9 * static_cast<double>(time) / CLOCKS_PER_SEC / particleSteps; }
};

void measure(const std::vector<std::string>& wanted) {
  const std::pair<const char*, std::string> layouts[] = {{"tank", ""},
                                                         {"blocks_130", thickBlocks()},
                                                         {"posts_500", posts()},
                                                         {"plates_500", plates()},
                                                         {"cubes_5000", cubes()},
                                                         {"bed_5040", bed()},
                                                         {"scenery_500", scenery(1)},
                                                         {"scenery_5000", scenery(10)}};
  std::vector<Run> runs;
  for (const auto& [name, boxes] : layouts) {
    if (!runs.empty() && !wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end())
      continue;
    const std::string text = R"({"format": 1, "particle_spacing": 0.05,
      "fluid": [{"shape": "box", "min": [0, 0.45, 0], "max": [4.2, 0.7, 3.4]}], "boundary": {"surfaces": [
      {"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [4.2, 2, 3.4]})" +
                             boxes + "]}}";
    runs.push_back({name, std::make_unique<Simulation>(parseScene(text), 1)});
  }
  while (runs.front().simulation->time() < 0.6) {
    for (Run& run : runs) {
      const long steps = run.simulation->view().info.steps;
      const std::clock_t before = std::clock();
      run.simulation->advanceFrame();
      run.time += std::clock() - before;
      const FrameView view = run.simulation->view();
      run.particleSteps +=
          static_cast<double>(view.info.steps - steps) * static_cast<double>(view.positions.size());
    }
  }
  std::printf("%-14s %10s %20s %14s  %s\n", "boxes", "particles", "ns a particle, step", "over the tank",
              "state");
  for (const Run& run : runs) {
    const std::size_t particles = run.simulation->view().positions.size();
    std::printf("%-14s %10zu %20.0f %14.2f  %016llx\n", run.label.c_str(), particles, run.nanoseconds(),
                run.nanoseconds() / runs.front().nanoseconds(),
                static_cast<unsigned long long>(run.simulation->stateHash()));
  }
}

}  // namespace
}  // namespace migiwa::benchmarks

int main(int argc, char** argv) {
  migiwa::benchmarks::measure({argv + 1, argv + argc});
  return 0;
}
