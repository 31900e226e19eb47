#include <algorithm>
#include <array>

#include "core/solver/parameters.h"
#include "core/solver/state.h"
#include "core/solver/step.h"

namespace migiwa::stages {

namespace {

/// Below this, 1/gamma stops meaning a density: a lone particle in a corner would already read as compressed.
constexpr float kGammaFloor = 0.2F;
/// Particles this many support radii from a wall are watched: they may reach it within the iterations.
constexpr float kWatchReach = 1.5F;
/// gamma is taken as linear over moves up to this many support radii.
constexpr float kLinearReach = 0.05F;

/// Evaluates the samples of slot(k), k < count, at their points, a batch at a time. Without a method the
/// distances alone.
template <class Slot>
void evaluate(const StepState& state, std::size_t count, const Slot& slot) {
  if (state.gammaMethod == nullptr) {
    for (std::size_t k = 0; k < count; ++k)
      slot(k).sample.distance = state.boundary.distance(slot(k).at.xyz());
    return;
  }
  std::array<Float4, 64> points;
  std::array<GammaSample, 64> samples;
  for (std::size_t begin = 0; begin < count; begin += points.size()) {
    const std::size_t n = std::min(points.size(), count - begin);
    for (std::size_t k = 0; k < n; ++k) points[k] = slot(begin + k).at;
    state.gammaMethod->evaluate(std::span(points).first(n), std::span(samples).first(n));
    for (std::size_t k = 0; k < n; ++k) slot(begin + k).sample = samples[k];
  }
}

/// Takes what is known of a particle that is now at p along with the wall in its reach. False where a wall
/// that has moved is in reach together with one that did not move with it: there gamma changes with time.
bool carryAlong(const StepState& state, const Vec3f& p, WallSlot& slot) {
  const float reach = (1 + kLinearReach) * state.supportRadius;
  const MovingSurface* mover = nullptr;
  for (const auto& wall : state.boundary.moving()) {
    if (!wall->moved()) continue;
    // One that has just gone out of reach was in it.
    Vec3f normal;
    if (wall->distance(p, normal) >= reach + (wall->carried(p) - p).norm()) continue;
    if (mover != nullptr && mover->group() != wall->group()) return false;
    mover = wall.get();
  }
  if (mover == nullptr) return true;
  for (const auto& surface : state.boundary.surfaces()) {
    const auto* const wall = dynamic_cast<const MovingSurface*>(surface.get());
    if (wall != nullptr && wall->group() == mover->group()) continue;
    Vec3f normal;
    if (surface->distance(p, normal) < reach) return false;
  }
  slot.at = Float4(mover->carried(slot.at.xyz()));
  slot.sample.gradient = mover->carriedDirection(slot.sample.gradient);
  slot.sample.pairGradient = mover->carriedDirection(slot.sample.pairGradient);
  return true;
}

/// Has the particle know at the place where its step began what was measured on the way.
void remember(StepState& state, const WallSlot& slot) {
  if (!state.boundary.steady()) return;
  Float4& start = state.particles.position[slot.particle];
  start.w = std::max(start.w, clearanceAt(state.boundary, start.xyz(), slot.at.xyz(), slot.sample.distance));
}

float linearGamma(const WallSlot& slot, const Vec3f& moved, float supportRadius) {
  return std::min(slot.sample.gamma + slot.sample.gradient.dot(moved) / supportRadius, 1.0F);
}

long floorGamma(const StepState& state, float& gamma) {
  if (!state.guards || gamma >= kGammaFloor || state.addsWallDensity()) return 0;
  gamma = kGammaFloor;
  return 1;
}

void countOutOfRange(StepState& state) {
  if (state.gammaMethod != nullptr) state.gammaOutOfRange += state.gammaMethod->takeOutOfRange();
}

}  // namespace

void evaluateGamma(StepState& state) {
  const std::size_t n = state.particles.size();
  if (state.boundary.empty()) {
    state.gamma.assign(n, 1);
    state.wallSlot.assign(n, FluidState::kNoWall);
    return;
  }
  state.gamma.resize(n);
  state.wallSlot.resize(n, FluidState::kNoWall);

  struct Found {
    std::vector<WallSlot> known, fresh;  // each in the order of the particles
  };
  std::vector<Found> found(chunkCount(n));
  const float reach = kLinearReach * state.supportRadius, watchReach = kWatchReach * state.supportRadius;
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    auto& [known, fresh] = found[chunk];
    for (std::size_t i = begin; i < end; ++i) {
      const auto particle = static_cast<std::uint32_t>(i);
      const Vec3f p = state.current[i].xyz();
      // What the step before knew of a particle that has hardly moved since holds for this one too.
      if (const std::uint32_t slot = state.wallSlot[i]; slot != FluidState::kNoWall) {
        WallSlot& old = state.wallSlots[slot];
        const bool holds = !state.boundary.moves() || carryAlong(state, p, old);
        if (holds && (p - old.at.xyz()).squaredNorm() <= reach * reach) {
          known.push_back(old);
          known.back().particle = particle;
          continue;
        }
      }
      if (knownClearance(state, i, p) < watchReach) fresh.push_back({particle, Float4(p), {}});
    }
    evaluate(state, fresh.size(), [&](std::size_t k) -> WallSlot& { return fresh[k]; });
    for (const WallSlot& slot : fresh) remember(state, slot);
    std::erase_if(fresh, [&](const WallSlot& slot) { return slot.sample.distance >= watchReach; });
  });

  // One after the other, each chunk from where those before it end.
  std::vector<std::size_t> first(found.size() + 1, 0);
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk)
    first[chunk + 1] = first[chunk] + found[chunk].known.size() + found[chunk].fresh.size();
  state.wallSlots.resize(first.back());
  std::vector<long> floored(found.size(), 0);
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    std::fill(&state.wallSlot[begin], &state.wallSlot[begin] + (end - begin), FluidState::kNoWall);
    std::fill(&state.gamma[begin], &state.gamma[begin] + (end - begin), 1.0F);
    std::size_t place = first[chunk];
    const auto take = [&](const WallSlot& slot) {
      state.wallSlot[slot.particle] = static_cast<std::uint32_t>(place);
      state.wallSlots[place++] = slot;
      float& gamma = state.gamma[slot.particle];
      gamma = linearGamma(slot, state.current[slot.particle].xyz() - slot.at.xyz(), state.supportRadius);
      floored[chunk] += floorGamma(state, gamma);
    };
    std::for_each(found[chunk].known.begin(), found[chunk].known.end(), take);
    std::for_each(found[chunk].fresh.begin(), found[chunk].fresh.end(), take);
  });
  for (const long count : floored) state.gammaFloored += count;
  countOutOfRange(state);
}

void refreshGamma(StepState& state) {
  if (state.gammaMethod == nullptr) return;
  const float reach = kLinearReach * state.supportRadius;
  state.gammaFloored += parallelReduce(
      state.pool, state.wallSlots.size(), 0L,
      [&](std::size_t begin, std::size_t end) {
        std::vector<WallSlot*> left;  // the neighbourhood of where they were evaluated
        for (std::size_t k = begin; k < end; ++k) {
          WallSlot& slot = state.wallSlots[k];
          const Float4& now = state.current[slot.particle];
          if (!((now.xyz() - slot.at.xyz()).squaredNorm() > reach * reach)) continue;
          slot.at = now;
          left.push_back(&slot);
        }
        evaluate(state, left.size(), [&](std::size_t k) -> WallSlot& { return *left[k]; });
        long floored = 0;
        for (std::size_t k = begin; k < end; ++k) {
          const WallSlot& slot = state.wallSlots[k];
          float& gamma = state.gamma[slot.particle];
          gamma = linearGamma(slot, state.current[slot.particle].xyz() - slot.at.xyz(), state.supportRadius);
          floored += floorGamma(state, gamma);
        }
        return floored;
      },
      [](long a, long b) { return a + b; });
  countOutOfRange(state);
}

}  // namespace migiwa::stages
