#include <numeric>
#include <string>

#include "core/base/parallel.h"
#include "core/simulation/fill.h"
#include "core/simulation/state.h"

namespace migiwa {

namespace {

constexpr int kStays = -1, kLeaves = -2;

/// Keeps the values whose particles stay.
template <class T>
void keep(std::vector<T>& values, const std::vector<int>& fates) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < fates.size(); ++i)
    if (fates[i] == kStays) values[kept++] = values[i];
  values.resize(kept);
}

}  // namespace

Outflow::Outflow(const Scene& scene) {
  for (const Drain& drain : scene.drains) outlets_.push_back({drain, DrainRegion(drain)});
}

bool Outflow::anyOpen(double time) const {
  for (const Outlet& outlet : outlets_)
    if (outlet.drain.openAt(time)) return true;
  return false;
}

int Outflow::fateOf(const Vec3d& p, double time, const Bounds& domain) const {
  for (std::size_t k = 0; k < outlets_.size(); ++k)
    if (outlets_[k].drain.openAt(time) && outlets_[k].region.contains(p)) return static_cast<int>(k);
  return domain.empty() || domain.contains(p) ? kStays : kLeaves;
}

EnergySums Outflow::remove(double time, const Bounds& domain, const Vec3f& centre, StepState& state,
                           RunStatistics& statistics) const {
  Particles& particles = state.particles;
  const std::size_t n = particles.size();
  std::vector<int> fates(n);
  const long going = parallelReduce(
      state.pool, n, 0L,
      [&](std::size_t begin, std::size_t end) {
        long count = 0;
        for (std::size_t i = begin; i < end; ++i) {
          fates[i] = fateOf(particles.position[i].xyz().cast<double>(), time, domain);
          if (fates[i] != kStays) ++count;
        }
        return count;
      },
      [](long a, long b) { return a + b; });
  EnergySums gone;
  if (going == 0) return gone;

  FluidBalance& fluid = statistics.fluid;
  for (std::size_t i = 0; i < n; ++i) {
    if (fates[i] == kStays) continue;
    gone.add(particles.position[i].xyz(), particles.velocity[i].xyz(), centre);
    if (fates[i] == kLeaves) {
      ++fluid.left;
    } else {
      ++fluid.drains.at(static_cast<std::size_t>(fates[i])).particles;
    }
  }
  // Samples of gamma stay where they are until the step makes its own: particles name theirs.
  if (state.wallSlot.size() == n) keep(state.wallSlot, fates);
  if (state.projectedPressure.size() == n) keep(state.projectedPressure, fates);
  keep(particles.position, fates);
  keep(particles.velocity, fates);
  keep(particles.id, fates);
  statistics.energy.takeOut(gone, state.gravity.cast<double>());
  return gone;
}

std::int64_t FluidBalance::drained() const {
  return std::accumulate(drains.begin(), drains.end(), std::int64_t{0},
                         [](std::int64_t sum, const DrainTally& drain) { return sum + drain.particles; });
}

void FluidBalance::sample(double time) {
  for (DrainTally& drain : drains) drain.thinning.add(drain.history, {time, drain.particles});
}

void FluidBalance::visit(StateVisitor& visitor) {
  visitor.integer("/fluid/started", started);
  visitor.integer("/fluid/emitted", emitted);
  visitor.integer("/fluid/left", left);
  auto count = static_cast<std::int64_t>(drains.size());
  visitor.integer("/fluid/drains", count);
  if (count != static_cast<std::int64_t>(drains.size()))
    throw StateError("the state of " + std::to_string(drains.size()) + " drains, found that of " +
                     std::to_string(count));
  for (std::size_t k = 0; k < drains.size(); ++k) {
    const std::string name = "drain_" + std::to_string(k);
    visitor.integer("/fluid/" + name + "/particles", drains[k].particles);
    visitor.array("fluid/" + name, drains[k].history);
    drains[k].thinning.visit(visitor, "/fluid/" + name);
  }
}

}  // namespace migiwa
