#include "tests/hard_cases/hard_case.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/scene/scene_file.h"
#include "core/walls/boundary.h"
#include "tests/hard_cases/energy_watch.h"

namespace migiwa::testing {

namespace {

/// Of all particles, over the mass.
Vec3d momentumOf(const FrameView& view) {
  Vec3d sum = Vec3d::Zero();
  for (const Float4& v : view.velocities) sum += v.xyz().cast<double>();
  return sum / std::max<double>(1, static_cast<double>(view.velocities.size()));
}

void watchWalls(const Boundary& boundary, const Scene& scene, const FrameView& view, Observed& seen) {
  for (const Float4& p : view.positions) {
    seen.lowest = std::min(seen.lowest, static_cast<double>(p.y));
    if (!boundary.empty())
      seen.nearest =
          std::min(seen.nearest, static_cast<double>(boundary.distance(p.xyz())) / scene.particleSpacing);
  }
}

/// The rms speed of single frames, and over them.
class RestWatch {
 public:
  void see(const FrameView& view) {
    double squares = 0;
    for (const Float4& v : view.velocities) squares += v.xyz().cast<double>().squaredNorm();
    squares /= std::max<double>(1, static_cast<double>(view.velocities.size()));
    squares_ += squares, speeds_ += std::sqrt(squares), ++frames_;
  }
  void finish(Observed& seen) const {
    if (frames_ == 0) return;
    const double square = squares_ / frames_, mean = speeds_ / frames_;
    seen.rmsSpeed = std::sqrt(square);
    seen.rmsSpread = std::sqrt(std::max(0.0, square - mean * mean));
  }

 private:
  double squares_ = 0, speeds_ = 0;
  int frames_ = 0;
};

}  // namespace

Scene sceneOf(const HardCase& hardCase, const std::string& method, VelocityStep velocities) {
  std::vector<Override> overrides;
  if (velocities == VelocityStep::positions) overrides.push_back({"/solver/velocity_step", "positions"});
  if (!method.empty()) overrides.push_back({"/boundary/gamma/method", method});
  Scene scene =
      readScene(std::string(MIGIWA_SOURCE_DIR "/scenes/hard/") + hardCase.scene + ".json", overrides);
  const auto fluid = scene.fluid;
  for (int copy = 1; copy < hardCase.copies; ++copy)
    scene.fluid.insert(scene.fluid.end(), fluid.begin(), fluid.end());
  return scene;
}

Observed observe(const Scene& scene, double until, int threads, Guards guards) {
  Simulation simulation(scene, threads, guards);
  const Boundary boundary(scene.surfaces);
  Observed seen;
  EnergyWatch energy(simulation);
  RestWatch rest;
  const Vec3d momentum = momentumOf(simulation.view());
  watchWalls(boundary, scene, simulation.view(), seen);
  const long last = simulation.frameAt(until);
  while (simulation.frame() < last && !simulation.stopped()) {
    simulation.advanceFrame();
    energy.look();
    const FrameView view = simulation.view();
    seen.momentum = (momentumOf(view) - momentum - simulation.time() * scene.gravity).norm();
    watchWalls(boundary, scene, view, seen);
    if (10 * simulation.frame() > 9 * last) rest.see(view);
  }
  energy.finish(seen);
  const RunStatistics& run = simulation.statistics();
  seen.maxSpeed = run.maxSpeed;
  seen.penetration = run.maxPenetration;
  seen.lost = run.lostParticles, seen.nonfinite = run.nonfiniteParticles;
  seen.worstError = run.densityErrorMax;
  const FrameView view = simulation.view();
  if (!view.info.errors.empty()) seen.meanError = view.info.errors.back().mean;
  seen.particles = view.positions.size();
  rest.finish(seen);
  seen.steps = run.steps;
  if (simulation.stopped()) seen.stopped = simulation.time();
  seen.divided = run.steps > simulation.frame() * scene.solver.substeps;
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
  most("energy gained (J/kg)", seen.energyGain, seen.energyBound);
  most("energy that the balance is off (J/kg)", seen.balanceOff, seen.balanceBound);
  most("speed (m/s)", seen.maxSpeed, expected.speed);
  most("mean density error at the end", seen.meanError, expected.meanError);
  most("largest density error", seen.worstError, expected.worstError);
  if (expected.rmsSpeed >= 0) most("rms speed in the last tenth (m/s)", seen.rmsSpeed, expected.rmsSpeed);
  most("depth of the lowest particle (m)", -seen.lowest, -expected.lowest);
  // Without walls nothing but gravity changes the momentum.
  if (seen.particles > 0 && !std::isfinite(seen.nearest))
    most("momentum (m/s)", seen.momentum, 1e-4 * std::max(seen.maxSpeed, 1.0));
  if (const Fill& fill = expected.fill; fill.layer > 0) {
    double filled = 0;
    for (const Float4& p : seen.end.view().positions) filled += static_cast<double>(p.y) < fill.below ? 1 : 0;
    most("particles more or less than fit below", std::abs(filled - fill.particles), fill.layer);
  }
  most("time of its own end (s)", seen.stopped, expected.stopsBefore);
  most("time of its own end, less (s)", -seen.stopped, -expected.stopsAfter);
  // Whether two particles ever meet on one point, in a corner or after an impact, may hang on the last bit.
  std::vector<std::string> acted = seen.guards;
  if (std::find(expected.guards.begin(), expected.guards.end(), "coincident") == expected.guards.end())
    std::erase(acted, "coincident");
  if (acted != expected.guards) {
    std::string found;
    for (const std::string& guard : seen.guards) found += " " + guard;
    list.push_back("other guards have acted than expected:" + found);
  }
  return list;
}

std::string outcome(const HardCase& expected, const Observed& seen) {
  std::ostringstream text;
  text << std::setprecision(2);
  const auto say = [&]() -> std::ostream& { return text.tellp() > 0 ? text << ", " : text; };
  if (seen.nonfinite > 0) {
    text << "not finite at step " << seen.steps;
    return text.str();
  }
  if (seen.lost > 0) say() << seen.lost << " particles lost at step " << seen.steps;
  if (seen.penetration > 0) say() << seen.penetration << " m past a wall";
  if (seen.lowest < expected.lowest) say() << expected.lowest - seen.lowest << " m too deep";
  if (!(seen.energyGain <= seen.energyBound)) {
    say() << "energy ";
    if (seen.energyBound > 0)
      text << seen.energyGain / seen.energyBound << " times its bound";
    else
      text << "+" << seen.energyGain << " J/kg";
  }
  if (!(seen.maxSpeed <= expected.speed)) say() << seen.maxSpeed << " m/s";
  if (!(seen.meanError <= expected.meanError)) say() << "mean density error " << seen.meanError;
  if (!(seen.worstError <= expected.worstError)) say() << "density error " << seen.worstError;
  if (expected.rmsSpeed >= 0 && !(seen.rmsSpeed <= expected.rmsSpeed))
    say() << "rms speed " << seen.rmsSpeed << " m/s in the last tenth";
  return text.tellp() > 0 ? text.str() : "holds";
}

}  // namespace migiwa::testing
