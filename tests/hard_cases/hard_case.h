// A hard case: a scene of scenes/hard/, and what mechanics says of its run.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/simulation.h"

namespace migiwa::testing {

/// What a run was seen to do. Energies are those of all particles over their mass (J/kg = m^2/s^2), from
/// positions and velocities at the end of each frame: the program's own balance is what they are held
/// against.
struct Observed {
  double energyGain = 0;    ///< most that kinetic + potential energy ever was above the start's; what moving
                            ///< walls and emitters gave, which they alone know, is taken off
  double energyBound = 0;   ///< the most that it may: what was stored at the start, see EnergyWatch
  double balanceOff = 0;    ///< most that the program's balance ever was off what was seen
  double balanceBound = 0;  ///< the most that it may: rounding
  double maxSpeed = 0;      ///< (m/s)
  double penetration = 0;   ///< (m)
  long lost = 0, nonfinite = 0;
  double nearest = std::numeric_limits<double>::infinity();  ///< least distance to a wall over the spacing
  double momentum = 0;    ///< change of momentum per mass that gravity does not explain (m/s)
  double meanError = 0;   ///< mean of max(rho/rho0 - 1, 0) at the end
  double worstError = 0;  ///< its largest at any time
  /// Root of the mean square over particles and the frames of the last tenth of the run (m/s), and by how
  /// much that of single frames spreads about it: what trembles is judged by no chance moment.
  double rmsSpeed = 0, rmsSpread = 0;
  double lowest = std::numeric_limits<double>::infinity();  ///< least coordinate y of a particle, ever (m)
  long steps = 0;
  double stopped = 0;    ///< when the run ended itself (s); 0: it did not
  bool divided = false;  ///< some frame took more than its step
  std::size_t particles = 0;
  std::uint64_t hash = 0;
  std::vector<std::string> guards;  ///< kinds of trouble that the run notes
  FrameSnapshot end;
};

/// Particles below a height at the end, where so many fit.
struct Fill {
  double below = 0;      ///< height (m)
  double particles = 0;  ///< that fit there, by the volume
  double layer = 0;  ///< it may be so many more or less, as in a layer one spacing high; 0: nothing is stated
};

struct HardCase {
  std::string name;         ///< of the case
  std::string scene;        ///< file in scenes/hard/ without its ending
  double until = 0;         ///< (s)
  double speed = 0;         ///< largest speed at any time (m/s)
  double meanError = 0.01;  ///< largest mean density error at the end
  double worstError = 0.5;  ///< largest density error at any time
  double rmsSpeed = -1;     ///< largest rms speed in the last tenth (m/s); negative: still moving
  double lowest = -1e9;     ///< no particle is ever below (m)
  double stopsAfter = 0, stopsBefore = 0;  ///< when the run ends itself (s); 0: it does not
  Fill fill;                               ///< of a part of the scene
  int copies = 1;                          ///< times that the scene's fluid is there
  bool everyMethod = false;                ///< also with other gamma methods than the scene's
  bool byProjection = true;                ///< also with velocities by projection
  std::vector<std::string> guards;         ///< that have to act, and no other ones but `coincident`
};

std::vector<HardCase> hardCases();

/// With the copies, and another gamma method or none if `method` is empty.
Scene sceneOf(const HardCase& hardCase, const std::string& method = {},
              VelocityStep velocities = VelocityStep::positions);

/// Runs a scene for a time and watches every frame.
Observed observe(const Scene& scene, double until, int threads = 1, Guards guards = Guards::on);

/// What does not hold, one sentence each.
std::vector<std::string> violations(const HardCase& hardCase, const Observed& seen);

/// What a run that may have no guards comes to, in a few words.
std::string outcome(const HardCase& hardCase, const Observed& seen);

/// The README of this folder.
std::string tableText();

}  // namespace migiwa::testing
