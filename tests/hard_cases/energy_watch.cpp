#include "tests/hard_cases/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/sph/kernels.h"
#include "tests/hard_cases/hard_case.h"

namespace migiwa::testing {

EnergyWatch::EnergyWatch(const Simulation& simulation) : simulation_(simulation) {
  const FrameView view = simulation.view();
  const Scene& scene = simulation.scene();
  const double strength = scene.gravity.norm();
  const Vec3d up = strength > 0 ? Vec3d(-scene.gravity / strength) : Vec3d(Vec3d::Zero());
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, largest = 0;
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    const double height = up.dot(view.positions[i].xyz().cast<double>());
    lowest = std::min(lowest, height), highest = std::max(highest, height);
    const double error = std::max(static_cast<double>(view.density[i]) - 1, 0.0);
    largest = std::max(largest, error);
    squares_ += error * error;
    startVelocity_ += view.velocities[i].xyz().cast<double>();
  }
  startParticles_ = static_cast<long>(view.positions.size());
  if (startParticles_ > 0) {
    squares_ /= static_cast<double>(startParticles_);
    startVelocity_ /= static_cast<double>(startParticles_);
    lift_ = 0.5 * largest * strength * (highest - lowest);
  }
  // No step has gone before: velocities are those of the start.
  start_ = lowest_ = energyNow(0).low;
}

EnergyWatch::Range EnergyWatch::energyNow(double meanStep) const {
  const FrameView view = simulation_.view();
  const Scene& scene = simulation_.scene();
  const Bounds bounds = scene.bounds();
  const Vec3d centre = bounds.empty() ? Vec3d(Vec3d::Zero()) : Vec3d(bounds.center());
  const auto count = static_cast<double>(view.positions.size());
  if (count == 0) return {};
  const double longest = scene.solver.timeStep / scene.solver.substeps;
  const bool divided = meanStep > 0 && meanStep < (1 - 1e-9) * longest;
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double step :
       {divided ? 0.5 * meanStep : meanStep, divided ? std::min(2 * meanStep, longest) : meanStep}) {
    double sum = 0;
    for (std::size_t i = 0; i < view.positions.size(); ++i) {
      const Vec3d velocity = view.velocities[i].xyz().cast<double>() + 0.5 * step * scene.gravity;
      sum +=
          0.5 * velocity.squaredNorm() - scene.gravity.dot(view.positions[i].xyz().cast<double>() - centre);
    }
    range.low = std::min(range.low, sum / count), range.high = std::max(range.high, sum / count);
  }
  return range;
}

double EnergyWatch::rounding() const {
  const RunStatistics& run = simulation_.statistics();
  const Bounds bounds = simulation_.scene().bounds();
  const double farthest = bounds.empty() ? 0 : bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).norm();
  const double dt = run.steps > 0 ? simulation_.time() / static_cast<double>(run.steps) : 1;
  return dt > 0 ? 0x1p-24 * farthest / dt * run.maxSpeed * std::sqrt(static_cast<double>(run.steps)) : 0;
}

void EnergyWatch::look() {
  const RunStatistics& run = simulation_.statistics();
  const Scene& scene = simulation_.scene();
  const long taken = run.steps - steps_;
  if (taken <= 0) return;
  const double meanStep = scene.solver.timeStep / static_cast<double>(taken);
  if (steps_ == 0) {
    const RestingLattice lattice = restingLattice(scene.solver.kernel, scene.solver.supportRatio);
    const double speed = scene.supportRadius() / meanStep;
    // Half a step on, where the balance of the first step begins.
    halfStep_ =
        static_cast<double>(startParticles_) * (0.5 * meanStep * scene.gravity.dot(startVelocity_) +
                                                0.125 * meanStep * meanStep * scene.gravity.squaredNorm());
    stored_ = 0.5 * squares_ * speed * speed / static_cast<double>(lattice.squaredGradients);
  }
  if (steps_ > 0) changes_ += std::abs(meanStep - lastStep_);
  lastStep_ = meanStep;
  steps_ = run.steps;
  const auto count = std::max<double>(1, static_cast<double>(simulation_.view().positions.size()));
  const Range now = energyNow(meanStep);
  const double given = (run.energy.walls + run.energy.emitters + run.energy.outflow) / count;
  gained_ = std::max(gained_,
                     now.low - (start_ * static_cast<double>(startParticles_) + halfStep_) / count - given);
  regained_ = std::max(regained_, now.low - given - lowest_);
  lowest_ = std::min(lowest_, now.high - given);
  const double balanced =
      (run.energy.start + halfStep_ + run.energy.solver + run.energy.effects) / count + given;
  off_ = std::max({off_, now.low - balanced, balanced - now.high});
  divided_ = divided_ || taken > scene.solver.substeps;
}

double EnergyWatch::bound() const {
  const RunStatistics& run = simulation_.statistics();
  const double gravity = simulation_.scene().gravity.norm();
  const double dt = run.steps > 0 ? simulation_.time() / static_cast<double>(run.steps) : 0;
  return 2 * stored_ + lift_ + 0.5 * (gravity * dt) * (gravity * dt) +
         0.5 * gravity * run.maxSpeed * changes_ + rounding();
}

void EnergyWatch::finish(Observed& seen) const {
  const RunStatistics& run = simulation_.statistics();
  const double gravity = simulation_.scene().gravity.norm();
  const double dt = run.steps > 0 ? simulation_.time() / static_cast<double>(run.steps) : 0;
  seen.energyGain = gained_;
  seen.energyBound = bound();
  seen.balanceOff = off_;
  // Where steps change their length, so does the half of one by which velocities are behind.
  seen.balanceBound = 2 * rounding() + (divided_ ? 0.5 * gravity * dt * run.maxSpeed : 0);
}

}  // namespace migiwa::testing
