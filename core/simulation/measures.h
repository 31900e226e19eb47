// What a run is measured by: settled water, distances to neighbours, levels of a tank.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"

namespace migiwa {

// Distances counted rather than kept: a run of a million particles measures fifty million of them.

class SpacingHistogram {
 public:
  /// Bins of a spacing: a percentile is off by half a bin at most.
  static constexpr int kBins = 65536;

  /// `distance` over the particle spacing, from 0 up to some support radii.
  void add(float distance);
  /// By linear interpolation between order statistics; null without distances.
  std::optional<double> firstPercentile() const;
  /// For a save; `name` of an array, such as "settled/bulk".
  void visit(StateVisitor& visitor, const std::string& name);

 private:
  /// The distance that `rank` others are not beyond.
  double atRank(std::uint64_t rank) const;

  std::vector<std::uint64_t> counts_;  ///< of each bin, up to the last that is not empty
};

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
  struct Walls;
  std::shared_ptr<Walls> walls_;  ///< of the last scene, to be asked again
  SpacingHistogram nearWall_, bulk_;
  long last_ = -1;  ///< the run's last frame; negative: no run yet
};

// A box that holds the fluid and nothing else: where levels, edges and depths are known exactly.

struct UprightTank {
  Vec3d center;          ///< (m)
  Eigen::Matrix3d axes;  ///< columns; the second points up
  Vec3d half;            ///< along those axes (m)

  /// Of a point above the floor (m).
  double heightOf(const Vec3d& p) const { return axes.col(1).dot(p - center) + half.y(); }
  /// Level (m above the floor) of so much fluid (m^3), filled evenly.
  double levelOf(double volume) const { return volume / (4 * half.x() * half.z()); }
};

/// The box that holds the fluid, if gravity runs along one of its axes and nothing else stands in it.
std::optional<UprightTank> uprightTank(const Scene& scene);

// A run to a given time, sampled for the report on the way. Watching or drawing a run never changes its
// stepping.

/// Advances to the frame on which `until` (s) falls. `eachFrame` is called after every frame and may return
/// false to end early. Ends early, too, once the simulation has stopped itself. Samples the last tenth of the
/// run.
SettledMeasures runUntil(Simulation& simulation, double until, const std::function<bool()>& eachFrame = {});

/// The same with a sampler of the caller's: one that comes with a save (core/io/save_file.h) goes on where it
/// was, if its run was to end on the same frame.
SettledMeasures runUntil(Simulation& simulation, double until, SettledSampler& sampler,
                         const std::function<bool()>& eachFrame = {});

}  // namespace migiwa
