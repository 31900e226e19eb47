// The pressure that a run finds in the water against what it has to be at rest, rho0 g z at the depth z: what
// carries the water, and what would push on a wall. Pressures are those of core/solver/pressure.h.
//
// Layers are one spacing high, counted from the level that the fluid's volume has in the tank; what is above
// it is in the first, at depth 0. The error is
//   sqrt(sum_k n_k (p_k - rho0 g z_k)^2 / sum_k n_k) / (rho0 g H)
// over the layers k of n_k particles with the means p_k and z_k, H being the level over the floor.
#pragma once

#include <optional>
#include <vector>

#include "core/simulation/simulation.h"

namespace migiwa {

struct PressureLayer {
  double depth;      ///< mean (m)
  double pressure;   ///< mean (Pa)
  double particles;  ///< mean over the samples
};

class PressureProfile {
 public:
  /// Takes in the frame that a watched simulation (Simulation::watchPressure) has just made. Nothing outside
  /// an upright tank.
  void sample(const Simulation& simulation);
  void sample(const Scene& scene, std::span<const Float4> positions, std::span<const float> pressures);
  /// From the level down; layers without particles are left out.
  std::vector<PressureLayer> layers() const;
  /// Null where there was no tank, no pressure or no particle.
  std::optional<double> error() const;

 private:
  struct Sums {
    double depth = 0, pressure = 0;
    long particles = 0;
  };
  std::vector<Sums> sums_;
  long samples_ = 0;
  double perDepth_ = 0;  ///< rho0 g (Pa/m)
  double level_ = 0;     ///< (m), of the last sample
};

}  // namespace migiwa
