// One path of light from the eye into the scene.
#pragma once

#include <cstdint>

#include "app/raytrace/optics.h"
#include "app/raytrace/stage.h"

namespace migiwa {

/// What a path brings to its pixel.
struct PathSample {
  Vec3f radiance = Vec3f::Zero();
  // Of the first place that is not smooth, seen through what is; they guide the denoiser.
  Vec3f normal = Vec3f::Zero();  ///< zero: the sky
  Vec3f albedo = Vec3f::Ones();
  float distance = 0;  ///< along the path (m)
};

/// What became of paths. Both ends of every stretch of a path say by themselves which medium is there.
struct PathCounts {
  std::uint64_t paths = 0, stretches = 0;
  std::uint64_t contradictions = 0;  ///< stretches whose ends disagreed
  std::uint64_t leaked =
      0;  ///< paths that no other choice at the beginning of the stretch could save: they end

  void add(const PathCounts& other) {
    paths += other.paths, stretches += other.stretches;
    contradictions += other.contradictions, leaked += other.leaked;
  }
};

/// Follows light backwards from `eye` along `direction` (unit), where `place` says what is there. At most
/// `bounces` surfaces; from the fourth on, dim paths end by Russian roulette.
PathSample tracePath(const Stage& stage, const Vec3f& eye, const Vec3f& direction, const Place& place,
                     PixelSamples& random, PathCounts& counts, int bounces = 256);

}  // namespace migiwa
