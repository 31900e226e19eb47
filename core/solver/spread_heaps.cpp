// A guard: pairs of particles that lie on one heap are as many as the square of their number, and so are the
// time and the memory of listing them. Heaps are therefore spread first, to the volume that their water fills
// at rest. Positions of the step's start and predicted ones move alike: no particle gains speed by it, and
// two and two move against each other, so that the centre of mass stays where no wall is in the way.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/portable_math.h"
#include "core/solver/coincident_pair.h"
#include "core/solver/stages.h"
#include "core/solver/thin_walls.h"

namespace migiwa::stages {

namespace {

/// How often what a cell of one support radius holds at rest a heap has at least. Fluid that overlaps twice
/// or thrice, and what single steps crowd, is left to the solver.
constexpr double kHeap = 8;
/// Walls throw back together what was spread through them, the fewer the more often.
constexpr int kMostRounds = 40;

struct Member {
  std::array<std::int64_t, 3> cell;
  std::uint32_t particle;
};

double fewestOfHeap(const StepState& state) {
  // Of a lattice that lies luckily a cell holds one layer more along each axis.
  const double across = static_cast<double>(state.supportRadius) / static_cast<double>(state.spacing) + 1;
  return kHeap * across * across * across;
}

/// The particles, those of one cell together. The grid's own cells may be much wider.
std::vector<Member> byCells(const StepState& state) {
  std::vector<Member> members;
  members.reserve(state.particles.size());
  const Vec3f origin = state.grid.origin();
  for (const std::uint32_t i : state.grid.order()) {
    const Vec3d place =
        (state.current[i].xyz() - origin).cast<double>() / static_cast<double>(state.supportRadius);
    constexpr double kFarthest = 9e15;  // what a double counts one by one
    if (!(place.cwiseAbs().maxCoeff() < kFarthest)) continue;
    const auto along = [&](int axis) { return static_cast<std::int64_t>(std::floor(place[axis])); };
    members.push_back({{along(0), along(1), along(2)}, i});
  }
  std::stable_sort(members.begin(), members.end(),
                   [](const Member& a, const Member& b) { return a.cell < b.cell; });
  return members;
}

/// Moves a particle by `way`, as far as walls let it.
void displace(StepState& state, std::uint32_t i, const Vec3f& way) {
  Float4& start = state.particles.position[i];
  const Vec3f from = start.xyz();
  Vec3f to = from + way;
  if (!state.barringWalls.empty()) to = heldBack(state.barringWalls, from, true, to, state.wallMargin());
  state.boundary.project(to, state.wallMargin());
  start = Float4(to);
  state.current[i] = Float4(Vec3f(state.current[i].xyz() + (to - from)));
}

/// Spreads the members over a ball: pair by pair to opposite sides, the radii such that they fill it evenly.
void spreadHeap(StepState& state, std::span<const Member> heap) {
  const std::size_t pairs = heap.size() / 2;
  const double radius = portable::cbrt(3 * static_cast<double>(heap.size()) / (4 * std::numbers::pi)) *
                        static_cast<double>(state.spacing);
  for (std::size_t k = 0; k < pairs; ++k) {
    const std::uint32_t one = heap[2 * k].particle, other = heap[2 * k + 1].particle;
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(pairs);
    const Vec3f way = static_cast<float>(radius * portable::cbrt(share)) *
                      coincidentDirection(state.particles.id[one], state.particles.id[other]);
    displace(state, one, way);
    displace(state, other, -way);
  }
}

}  // namespace

void spreadHeaps(StepState& state) {
  const double fewest = fewestOfHeap(state);
  for (int round = 0; round < kMostRounds && state.grid.fullestCell() > fewest; ++round) {
    const std::vector<Member> members = byCells(state);
    long spread = 0;
    for (auto begin = members.begin(); begin != members.end();) {
      const auto end = std::find_if(begin, members.end(),
                                    [&](const Member& member) { return member.cell != begin->cell; });
      if (static_cast<double>(end - begin) > fewest) {
        spreadHeap(state, {begin, end});
        spread += end - begin;
      }
      begin = end;
    }
    if (spread == 0) return;
    if (round == 0) state.spreadParticles += spread;
    projectAll(state);
    state.grid.build(std::span(state.current).first(state.particles.size()), state.supportRadius, state.pool);
  }
}

}  // namespace migiwa::stages
