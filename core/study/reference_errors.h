// How wrong a state is, judged by a reference that is the same for every run: gamma from 16384 directions a
// particle ("directions", whatever the run itself uses), and densities that are summed anew from the
// positions and divided by that gamma. So runs with different corrections, or with none, compare.
//
// Near a wall means nearer than the support radius. Over the samples:
//   gamma error     |gamma of the run - reference gamma|, mean and largest over the particles near walls; a
//                   run without correction has gamma = 1
//   gradient error  |h grad gamma - reference|, mean over the particles near walls
//   density error   max(rho/rho0 - 1, 0) with the reference gamma ([FM] Eq. 5), mean and largest over all
//                   particles
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/simulation/simulation.h"

namespace migiwa {

struct ReferenceErrors {
  std::optional<double> gammaMean, gammaMax;      ///< null where no particle was near a wall
  std::optional<double> gradientMean;             ///< null there, and where no gradients were given
  std::optional<double> densityMean, densityMax;  ///< null without particles
};

class ReferenceSampler {
 public:
  /// Of the reference: its error is below 0.001 at edges and corners (tests/study).
  static constexpr int kDirections = 16384;

  /// `threads` as for a Simulation.
  explicit ReferenceSampler(int threads) : threads_(threads) {}

  void sample(const Simulation& simulation);
  /// The same for particles from elsewhere, at `time` (s): `gamma` and `gradients` (h grad gamma; empty: not
  /// known) are what the run took for each of `positions` (m).
  void sample(const Scene& scene, double time, std::span<const Float4> positions,
              std::span<const float> gamma, std::span<const Vec3f> gradients = {});
  ReferenceErrors result() const;

 private:
  int threads_;
  double gammaSum_ = 0, gammaMax_ = 0, gradientSum_ = 0, densitySum_ = 0, densityMax_ = 0;
  long nearWalls_ = 0, gradients_ = 0, particles_ = 0;
};

}  // namespace migiwa
