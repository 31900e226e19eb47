#include <algorithm>
#include <cmath>
#include <limits>

#include "core/solver/parameters.h"
#include "core/solver/state.h"
#include "core/solver/step.h"
#include "core/walls/wall_index.h"

namespace migiwa::stages {

namespace {

/// What lies right at the margin a shape may still move by the last bit: so much more is certainly enough.
constexpr float kAmple = 1.001F;

/// Share of the margin by which a particle at a wall may stand too near to it.
constexpr float kRounding = 0.01F;

/// What walls did to particles.
struct Push {
  double work = 0;  ///< how far times the velocity of the wall there (m^2/s), 0 where no wall moves
  std::vector<SuppressedPush> jumps;
};

/// A wall that stands still takes speed and gives none: it pushes no further than a particle has come since
/// the step began. Where distances jump, at the rim of an open SLIM surface, or two walls leave no room, it
/// does; what is too much of that leads from where the particle began, so that no speed comes of it.
void suppressPush(StepState& state, std::size_t i, const Vec3f& came, const Vec3f& pushed, Push& push) {
  Float4& began = state.particles.position[i];
  const float length = (pushed - came).norm();
  const float most = kSteepestDistance * (came - began.xyz()).norm() + kRounding * state.wallMargin();
  if (length <= most) return;
  push.jumps.push_back({state.particles.id[i], began});
  began = Float4(Vec3f(began.xyz() + (1 - most / length) * (pushed - came)));
}

/// Puts particle i, which came from `from`, where it was at the start of the step or since, back on the fluid
/// side, and books that.
/// All that it calls is put in its place: most particles are done after the first lines.
[[gnu::flatten]] void project(StepState& state, std::size_t i, const Float4& from, bool stepBegan,
                              Push& push) {
  Vec3f p = state.current[i].xyz();
  // A wall may be in its way unless there is more room at one end than the way is long.
  bool barred = false;
  if (!state.collisionWalls.empty()) {
    const float way = kAmple * state.boundary.steepness() * (p - from.xyz()).norm();
    barred = !knownFarther(state, i, p, state.wallMargin() + way) && !knownFarther(state, i, from.xyz(), way);
  }
  if (!barred && knownFarther(state, i, p, kAmple * state.wallMargin())) return;
  if (!p.allFinite()) return;  // no wall has a place for it; the step is about to be refused
  const Vec3f came = p;
  if (barred) p = clipMove(state.collisionWalls, from.xyz(), stepBegan, p, state.wallMargin());
  state.boundary.project(p, state.wallMargin());
  state.current[i].setXyz(p);
  if (p == came) return;
  if (state.boundary.moves()) {
    push.work += static_cast<double>(state.boundary.wallVelocity(p).dot(p - came));
  } else if (state.guards) {
    suppressPush(state, i, came, p, push);
  }
}

/// Calls one(k, push) for all k < count, and books the walls' work and the jumps.
template <class One>
void projectEach(StepState& state, std::size_t count, const One& one) {
  const Push all = parallelReduce(
      state.pool, count, Push{},
      [&](std::size_t begin, std::size_t end) {
        Push part;
        for (std::size_t k = begin; k < end; ++k) one(k, part);
        return part;
      },
      [](Push sum, const Push& part) {
        sum.work += part.work;
        sum.jumps.insert(sum.jumps.end(), part.jumps.begin(), part.jumps.end());
        return sum;
      });
  state.wallWork.add(all.work);
  state.suppressedPushes.insert(state.suppressedPushes.end(), all.jumps.begin(), all.jumps.end());
}

}  // namespace

void projectNearWalls(StepState& state) {
  const UprightVessel* const vessel = state.boundary.onlyVessel();
  projectEach(state, state.wallSlots.size(), [&](std::size_t k, Push& push) {
    const std::uint32_t i = state.wallSlots[k].particle;
    if (vessel != nullptr && vessel->holds(state.current[i].xyz(), state.wallMargin())) return;
    project(state, i, state.previous[i], false, push);
  });
}

void projectAll(StepState& state) {
  if (state.boundary.empty()) return;
  state.wallSlot.resize(state.particles.size(), FluidState::kNoWall);
  const UprightVessel* const vessel = state.boundary.onlyVessel();
  projectEach(state, state.particles.size(), [&](std::size_t i, Push& push) {
    if (vessel != nullptr && vessel->holds(state.current[i].xyz(), state.wallMargin())) return;
    project(state, i, state.particles.position[i], true, push);
  });
}

}  // namespace migiwa::stages

namespace migiwa {

WallIndex thinWalls(const Boundary& boundary, float supportRadius) {
  std::vector<const Surface*> thin;
  for (const auto& surface : boundary.surfaces())
    if (surface->thickness() < supportRadius) thin.push_back(surface.get());
  return {std::move(thin), supportRadius, false};
}

WallIndex collisionWalls(const Boundary& boundary, float supportRadius) {
  std::vector<const Surface*> barring;
  for (const auto& surface : boundary.surfaces())
    if (surface->thinnestPart() < supportRadius) barring.push_back(surface.get());
  for (const auto& wall : boundary.moving())
    if (std::isfinite(wall->thinnestPart()) && wall->thinnestPart() >= supportRadius)
      barring.push_back(wall.get());
  return {std::move(barring), supportRadius, false};
}

Vec3f clipMove(const WallIndex& walls, const Vec3f& from, bool stepBegan, const Vec3f& to, float margin) {
  Vec3f held = to, normal;
  const float length = (to - from).norm();
  for (const auto& [wall, block, vessel] : length < walls.reach() ? walls.near(from, length) : walls.all()) {
    if (block != nullptr && block->farther(from, (held - from).norm())) continue;
    const Vec3f start = stepBegan ? wall->carried(from) : from;
    float entry = 0;
    if (held == start || !wall->crosses(start, held, normal, entry)) continue;
    Vec3f ignored;
    if (wall->distance(start, ignored) < 0) continue;
    const Vec3f meets = start + entry * (held - start);
    held += (margin - (held - meets).dot(normal)) * normal;
  }
  return held;
}

}  // namespace migiwa
