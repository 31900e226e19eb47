// The measures of the report's "settled" block, in one place. Definitions, for spacing a and support radius
// h:
//   height             twice the height of the centre of mass above the tank's floor (m)
//   expected height    particles * a^3 / floor area (m)
//   edge crowding      particles in the strips a x a along the edges where two walls meet, up to the expected
//   height,
//                      over the number that an even filling (one particle per a^3) would put there
//   spacing p1         1st percentile of the nearest-neighbour distance over a; "near wall" is within h of a
//   surface,
//                      "bulk" all others
//   rms speed          root mean square over all particles (m/s)
// Heights and edge crowding need a box that holds the fluid and a gravity along one of its axes; null
// elsewhere.
#pragma once

#include <optional>
#include <vector>

#include "core/simulation/simulation.h"
#include "core/simulation/spacing_histogram.h"

namespace migiwa {

struct SettledMeasures {
  std::optional<double> height, expectedHeight, edgeCrowding;
  std::optional<double> nearWallSpacingP1, bulkSpacingP1;  ///< null where there is no such particle
  std::optional<double> rmsSpeed;                          ///< null without particles
};

/// Collects the measures over several frames and averages them; spacings are pooled.
class SettledSampler {
 public:
  void sample(const Simulation& simulation);
  /// The same for particles from elsewhere; velocities in m/s, of the same length as positions (m),
  /// between walls where they are at `time` (s).
  void sample(const Scene& scene, std::span<const Float4> positions, std::span<const Float4> velocities,
              double time = 0);
  SettledMeasures result() const;

  /// Samples belong to a run that ends at frame `last`: forgets those of another.
  void beginRun(long last);
  /// For a save.
  void visit(StateVisitor& visitor);

 private:
  struct Sums {
    double height = 0, expectedHeight = 0, edgeCrowding = 0, squaredSpeed = 0;
    int boxFrames = 0, frames = 0;
  } sums_;
  SpacingHistogram nearWall_, bulk_;
  long last_ = -1;  ///< the run's last frame; negative: no run yet
};

}  // namespace migiwa
