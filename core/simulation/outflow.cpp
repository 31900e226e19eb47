#include <algorithm>
#include <numeric>
#include <sstream>
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

/// Whether a place of the region may be `margin` (m) away from every wall. Boxes that are certainly nearer,
/// or beyond the region, are passed over, others divided.
class RoomInRegion {
 public:
  RoomInRegion(const DrainRegion& region, const Boundary& boundary, double margin)
      : region_(region), boundary_(boundary), margin_(margin) {}

  bool found() {
    const Bounds bounds = region_.bounds();
    return search(bounds.center(), 0.5 * bounds.size());
  }

 private:
  bool search(const Vec3d& center, const Vec3d& half) {
    // What takes so long to tell, or lies so near, is given the benefit of the doubt.
    constexpr int kMostAsked = 100000;
    constexpr double kSmallest = 1.0 / 16;
    if (!region_.within(center, half.norm())) return false;
    const auto distance = static_cast<double>(boundary_.distance(center.cast<float>()));
    if (distance >= margin_ && region_.contains(center)) return true;
    if (distance + static_cast<double>(boundary_.steepness()) * half.norm() < margin_) return false;
    int axis = 0;
    if (++asked_ > kMostAsked || half.maxCoeff(&axis) < kSmallest * margin_) return true;
    const Vec3d offset = 0.5 * half[axis] * Vec3d::Unit(axis);
    return search(center - offset, half - offset) || search(center + offset, half - offset);
  }

  const DrainRegion& region_;
  const Boundary& boundary_;
  double margin_;
  int asked_ = 0;
};

/// Of walls that move nobody knows here what they leave room for.
Boundary stillWalls(const Boundary& boundary) {
  std::vector<std::shared_ptr<const Surface>> still;
  for (const auto& surface : boundary.surfaces())
    if (dynamic_cast<const MovingSurface*>(surface.get()) == nullptr) still.push_back(surface);
  return Boundary::atRest(std::move(still));
}

std::string extentOf(const Bounds& bounds, const Vec3d& origin) {
  std::ostringstream text;
  text.precision(origin.isZero(0) ? 4 : 10);
  const auto place = [&](const Vec3d& p) {
    text << '(' << origin.x() + p.x() << ", " << origin.y() + p.y() << ", " << origin.z() + p.z() << ')';
  };
  place(bounds.min);
  text << " to ";
  place(bounds.max);
  text << " m";
  return text.str();
}

}  // namespace

Outflow::Outflow(Scene& scene, const Boundary& boundary) {
  const Bounds extent = scene.bounds();
  const Boundary still = stillWalls(boundary);
  // Walls keep the centres of particles half a spacing away, but for rounding.
  const double margin = (0.5 - 1e-3) * scene.particleSpacing;
  for (const Drain& drain : scene.drains) {
    outlets_.push_back({drain, DrainRegion(drain)});
    const DrainRegion& region = outlets_.back().region;
    const Bounds own = region.bounds();
    const std::string places = ": from " + extentOf(own, scene.origin) + "; fluid and walls reach from " +
                               extentOf(extent, scene.origin);
    const std::string named = "/drains/" + std::to_string(outlets_.size() - 1) + ": ";
    if (!still.empty() && !RoomInRegion(region, still, margin).found())
      scene.warnings.push_back(
          named +
          "it never takes anything, for all of it lies within the walls, outside of the vessel, or nearer "
          "to a wall than half a particle_spacing" +
          places + ". Move it to where fluid comes by");
    else if (const Vec3d gap = (own.min - extent.max).cwiseMax(extent.min - own.max).cwiseMax(0);
             !extent.empty() && gap.norm() > std::max(own.size().maxCoeff(), extent.size().maxCoeff()))
      scene.warnings.push_back(named + "it is far from fluid and walls" + places + ". Check the coordinates");
  }
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
