// How far from every wall a particle is at least, without asking the walls: what was measured somewhere, less
// the way from there. Where that is enough, walls have nothing to say.
#pragma once

#include <algorithm>

#include "core/solver/step_state.h"

namespace migiwa {

/// A bound for how fast the distances of walls change along a way. Of true distances it is 1; those of
/// splines and of SLIM surfaces overshoot a little about creases.
constexpr float kSteepestDistance = 1.5F;

/// A clearance (m) that is known at `there`, as known at p.
inline float clearanceAt(const Vec3f& p, const Vec3f& there, float clearance) {
  return clearance - kSteepestDistance * (p - there).norm();
}

/// The least distance (m) to walls that particle i can have at p, by what its step began with and by its wall
/// slot. 0: nothing is known; always so where walls
/// are not steady.
inline float knownClearance(const StepState& state, std::size_t i, const Vec3f& p) {
  if (!state.boundary.steady()) return 0;
  const Float4& start = state.particles.position[i];
  float clearance = clearanceAt(p, start.xyz(), start.w);
  if (const std::uint32_t slot = state.wallSlot[i]; slot != StepState::kNoWall) {
    const WallSlot& wall = state.wallSlots[slot];
    clearance = std::max(clearance, clearanceAt(p, wall.at.xyz(), wall.sample.distance));
  }
  return std::max(clearance, 0.0F);
}

}  // namespace migiwa
