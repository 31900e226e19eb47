// What SLIM surfaces can do, in numbers.
//   slim_report --orders FILE.csv: errors of distance and normal over the radius of the balls on exact
//   shapes,
//     and their orders
//   slim_report --mesh MESH: nodes against distances, and what an evaluation at the surface costs: of the
//   nodes
//     themselves, and of the grid that stands for them in a run with a support radius of 8 % of the mesh
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/slim/fit.h"
#include "core/slim/points.h"
#include "core/walls/gridded.h"
#include "core/walls/slim_wall.h"
#include "tests/slim/error_orders.h"

namespace migiwa {
namespace {

int writeOrders(const char* file) {
  ThreadPool pool;
  std::string csv = "shape,degree,radius_m,distance_m,normal_rad,distance_order,normal_order\n";
  std::printf("order of the distance and of the normal, as measured (expected)\n");
  for (const testing::OrderShape& shape : testing::orderShapes()) {
    for (int degree = 1; degree <= kLargestSlimDegree; ++degree) {
      std::vector<testing::OrderPoint> points;
      for (const double share : {1.0, 0.7071, 0.5, 0.3536, 0.25})
        points.push_back(testing::errorsAt(shape, degree, share * shape.radius, pool));
      const double distance = testing::orderOf(points, &testing::OrderPoint::distance);
      const double normal = testing::orderOf(points, &testing::OrderPoint::normal);
      for (const testing::OrderPoint& point : points) {
        char line[160];
        std::snprintf(line, sizeof line, "%s,%d,%.4g,%.4g,%.4g,%.2f,%.2f\n", shape.name.c_str(), degree,
                      point.radius, point.distance, point.normal, distance, normal);
        csv += line;
      }
      const int expected = testing::expectedOrder(shape, degree);
      std::printf("%-7s degree %d: distance %.2f (%d), normal %.2f (%d)\n", shape.name.c_str(), degree,
                  distance, expected, normal, expected - 1);
      std::fflush(stdout);
    }
  }
  writeTextFile(file, csv);
  return 0;
}

/// Nanoseconds of one distance at the points, the least of some rounds.
template <class Distance>
double cost(const std::vector<OrientedPoint>& points, const Distance& distance) {
  using Clock = std::chrono::steady_clock;
  double least = std::numeric_limits<double>::infinity();
  float sum = 0;
  for (int round = 0; round < 5; ++round) {
    const auto from = Clock::now();
    for (const OrientedPoint& point : points) sum += distance(point.position);
    least = std::min(least, std::chrono::duration<double, std::nano>(Clock::now() - from).count() /
                                static_cast<double>(points.size()));
  }
  return std::isfinite(sum) ? least : std::numeric_limits<double>::quiet_NaN();
}

int reportMesh(const char* file) {
  ThreadPool pool;
  const ImportedShape shape = importShape(file);
  const std::vector<OrientedPoint> unseen = samplePoints(shape.mesh, 100000, 2);
  const auto support = static_cast<float>(0.08 * shape.mesh.bounds().size().maxCoeff());
  std::printf("%-7s %7s %12s %10s %8s %14s %13s\n", "degree", "nodes", "largest (mm)", "mean (mm)", "fit (s)",
              "evaluation (ns)", "in a run (ns)");
  for (int degree = 1; degree <= kLargestSlimDegree; ++degree) {
    for (const int nodes : {1000, 5000, 25000, 100000}) {
      SlimFitOptions options;
      options.degree = degree;
      options.nodes = nodes;
      using Clock = std::chrono::steady_clock;
      const auto start = Clock::now();
      std::vector<SlimNode> fit = fitSlim(fitPoints(shape, nodes), options, pool);
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      const auto wall = std::make_shared<SlimWallData>();
      wall->model = std::make_unique<SlimModel>(std::move(fit), degree, shape.closed, pool);
      const SlimModel& model = *wall->model;
      const GriddedSurface gridded(std::make_shared<SlimSurface>(wall, SlimSurface::Fluid::outside), support,
                                   pool);
      const SlimStatistics statistics = measureSlim(model, unseen, pool);
      Vec3f normal;
      const double exact = cost(unseen, [&](const Vec3f& p) { return model.nearest(p).distance; });
      const double inRun = cost(unseen, [&](const Vec3f& p) { return gridded.distance(p, normal); });
      std::printf("%-7d %7zu %12.2f %10.3f %8.1f %14.0f %13.0f\n", degree, model.nodes().size(),
                  1000 * statistics.largest, 1000 * statistics.mean, seconds, exact, inRun);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace migiwa

int main(int argc, char** argv) {
  try {
    if (argc == 3 && std::strcmp(argv[1], "--orders") == 0) return migiwa::writeOrders(argv[2]);
    if (argc == 3 && std::strcmp(argv[1], "--mesh") == 0) return migiwa::reportMesh(argv[2]);
  } catch (const migiwa::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  std::fprintf(stderr, "usage: slim_report --orders FILE.csv | --mesh MESH\n");
  return 2;
}
