#include "tests/hard_cases/hard_case.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/boundary/boundary.h"
#include "core/scene/scene_reader.h"

namespace migiwa::testing {

namespace {

struct Mechanics {
  double energy = 0;  ///< (J/kg)
  double maxSpeed = 0;
  Vec3d momentum = Vec3d::Zero();  ///< per mass (m/s)
};

/// Heights count from `origin`, so that no digits are lost far from that of the scene.
Mechanics mechanicsOf(const FrameView& view, const Vec3d& gravity, const Vec3d& origin) {
  Mechanics sum;
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    const Vec3d x = view.positions[i].xyz().cast<double>(), v = view.velocities[i].xyz().cast<double>();
    sum.energy += 0.5 * v.squaredNorm() - gravity.dot(x - origin);
    sum.momentum += v;
    sum.maxSpeed = std::max(sum.maxSpeed, v.norm());
  }
  const double n = std::max<double>(1, static_cast<double>(view.positions.size()));
  sum.energy /= n, sum.momentum /= n;
  return sum;
}

void watchWalls(const Boundary& boundary, const Scene& scene, const FrameView& view, Observed& seen) {
  for (const Float4& p : view.positions) {
    seen.lowest = std::min(seen.lowest, static_cast<double>(p.y));
    if (!boundary.empty())
      seen.nearest =
          std::min(seen.nearest, static_cast<double>(boundary.distance(p.xyz())) / scene.particleSpacing);
  }
}

}  // namespace

Scene sceneOf(const HardCase& hardCase, const std::string& method) {
  std::vector<Override> overrides;
  if (!method.empty()) overrides.push_back({"/boundary/gamma/method", method});
  Scene scene =
      readScene(std::string(MIGIWA_SOURCE_DIR "/scenes/hard/") + hardCase.scene + ".json", overrides);
  const auto fluid = scene.fluid;
  for (int copy = 1; copy < hardCase.copies; ++copy)
    scene.fluid.insert(scene.fluid.end(), fluid.begin(), fluid.end());
  return scene;
}

Observed observe(const Scene& scene, double until, int threads) {
  Simulation simulation(scene, threads);
  const Boundary boundary(scene.surfaces);
  const Vec3d origin = scene.fluid.empty() ? Vec3d::Zero() : scene.fluid.front()->bounds().center();
  Observed seen;
  const Mechanics start = mechanicsOf(simulation.view(), scene.gravity, origin);
  watchWalls(boundary, scene, simulation.view(), seen);
  const long last = simulation.frameAt(until);
  while (simulation.frame() < last && !simulation.stopped()) {
    simulation.advanceFrame();
    const FrameView view = simulation.view();
    const Mechanics now = mechanicsOf(view, scene.gravity, origin);
    seen.energyGain = std::max(seen.energyGain, now.energy - start.energy);
    seen.momentum = (now.momentum - start.momentum - simulation.time() * scene.gravity).norm();
    watchWalls(boundary, scene, view, seen);
  }
  const RunStatistics& run = simulation.statistics();
  // The symplectic Euler step keeps E + dt g.v / 2 where a particle flies free, not E itself: from falling to
  // rising at the speed v it gains dt g v.
  const double dt =
      run.steps > 0 ? simulation.time() / static_cast<double>(simulation.frame()) : scene.solver.timeStep;
  seen.allowance =
      dt * scene.gravity.norm() * std::min(run.maxSpeed, std::sqrt(2 * std::max(start.energy, 0.0)) + 1);
  seen.maxSpeed = run.maxSpeed;
  seen.penetration = run.maxPenetration;
  seen.lost = run.lostParticles, seen.nonfinite = run.nonfiniteParticles;
  seen.worstError = run.densityErrorMax;
  const FrameView view = simulation.view();
  if (!view.info.errors.empty()) seen.meanError = view.info.errors.back().mean;
  double squares = 0;
  for (const Float4& v : view.velocities) squares += v.xyz().cast<double>().squaredNorm();
  seen.particles = view.positions.size();
  seen.rmsSpeed = std::sqrt(squares / std::max<double>(1, static_cast<double>(seen.particles)));
  seen.steps = run.steps;
  seen.hash = simulation.stateHash();
  for (const Trouble& trouble : run.trouble) seen.guards.push_back(trouble.kind);
  std::sort(seen.guards.begin(), seen.guards.end());
  seen.end.assign(view);
  return seen;
}

std::vector<std::string> violations(const HardCase& expected, const Observed& seen) {
  std::vector<std::string> list;
  const auto most = [&](const std::string& what, double value, double bound) {
    if (value <= bound) return;  // not-a-numbers are violations, too
    std::ostringstream text;
    text << what << ": at most " << bound << ", found " << value;
    list.push_back(text.str());
  };
  most("particles that are not finite", static_cast<double>(seen.nonfinite), 0);
  most("lost particles", static_cast<double>(seen.lost), 0);
  most("penetration (m)", seen.penetration, 0);
  most("energy gained (J/kg)", seen.energyGain, expected.energy + seen.allowance);
  most("speed (m/s)", seen.maxSpeed, expected.speed);
  most("mean density error at the end", seen.meanError, expected.meanError);
  most("largest density error", seen.worstError, expected.worstError);
  if (expected.rmsSpeed >= 0) most("rms speed at the end (m/s)", seen.rmsSpeed, expected.rmsSpeed);
  most("depth of the lowest particle (m)", -seen.lowest, -expected.lowest);
  // Without walls nothing but gravity changes the momentum.
  if (seen.particles > 0 && !std::isfinite(seen.nearest))
    most("momentum (m/s)", seen.momentum, 1e-4 * std::max(seen.maxSpeed, 1.0));
  if (seen.guards != expected.guards) {
    std::string found;
    for (const std::string& guard : seen.guards) found += " " + guard;
    list.push_back("other guards have acted than expected:" + found);
  }
  return list;
}

}  // namespace migiwa::testing
